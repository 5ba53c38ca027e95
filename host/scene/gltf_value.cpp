// SPDX-License-Identifier: Apache-2.0
// Typed access to the members of extension objects.
#include "scene/gltf_reader.h"

#include <cmath>

namespace obscura {

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number_member(const GltfReader& reader, const std::string& place, const tinygltf::Value& object,
                     const char* key, double fallback) {
    if (!object.Has(key)) return fallback;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble()))
        reader.fail(place, "{} must be a finite number.", key);
    return value.GetNumberAsDouble();
}

std::vector<double> vector_member(const GltfReader& reader, const std::string& place,
                                  const tinygltf::Value& object, const char* key,
                                  std::vector<double> fallback) {
    if (!object.Has(key)) return fallback;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsArray() || value.ArrayLen() != fallback.size())
        reader.fail(place, "{} must be a list of {} numbers.", key, fallback.size());
    std::vector<double> numbers;
    for (size_t i = 0; i < fallback.size(); ++i) {
        const tinygltf::Value& item = value.Get(static_cast<int>(i));
        if (!item.IsNumber() || !std::isfinite(item.GetNumberAsDouble()))
            reader.fail(place, "{} must hold finite numbers.", key);
        numbers.push_back(item.GetNumberAsDouble());
    }
    return numbers;
}

int index_member(const GltfReader& reader, const std::string& place, const tinygltf::Value& object,
                 const char* key, int fallback) {
    if (!object.Has(key)) return fallback;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsInt() || value.GetNumberAsInt() < 0) reader.fail(place, "{} must be an index.", key);
    return value.GetNumberAsInt();
}

}  // namespace obscura
