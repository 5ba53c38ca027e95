// SPDX-License-Identifier: Apache-2.0
// Small glTF files for tests: JSON that a test fills or breaks, one binary buffer, written as .glb or as
// .gltf with its buffer as a data URI or a .bin file.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace obscura::test {

// A fresh file each time: rewriting one in place makes ext4 flush it to disk, which fuzzing can't wait for.
inline void write_file(const std::string& path, const std::vector<uint8_t>& bytes) {
    std::filesystem::remove(path);
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

class GltfBuilder {
  public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<uint8_t> buffer;

    // A buffer view over new bytes, 4-byte aligned. Returns its index.
    int view(const void* data, size_t bytes) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        const size_t offset = buffer.size();
        buffer.resize(offset + bytes);
        if (bytes > 0) std::memcpy(buffer.data() + offset, data, bytes);
        return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
    }

    // type: SCALAR, VEC2, VEC3. Returns the accessor's index.
    template <typename T>
    int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
        const size_t components = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : 3;
        nlohmann::json accessor = {{"bufferView", view(values.data(), values.size() * sizeof(T))},
                                   {"componentType", component_type(T{})},
                                   {"count", values.size() / components},
                                   {"type", type}};
        if (normalized) accessor["normalized"] = true;
        return append("accessors", accessor);
    }

    // Appends to a top-level list. Returns the new entry's index.
    int append(const std::string& list, const nlohmann::json& entry) {
        json[list].push_back(entry);
        return static_cast<int>(json[list].size()) - 1;
    }

    // A mesh with one primitive; attributes as in {{"POSITION", 0}}.
    int mesh(const nlohmann::json& attributes, int indices = -1, const nlohmann::json& more = {}) {
        nlohmann::json primitive = {{"attributes", attributes}};
        if (indices >= 0) primitive["indices"] = indices;
        if (more.is_object()) primitive.update(more);
        return append("meshes", {{"name", "thing"}, {"primitives", nlohmann::json::array({primitive})}});
    }

    // One right triangle in z = 0 with its right angle at the origin, as a mesh on a node.
    void add_triangle() {
        const int positions = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        append("nodes", {{"mesh", mesh({{"POSITION", positions}})}});
    }

    std::vector<uint8_t> glb_bytes() const {
        nlohmann::json document = json;
        if (!buffer.empty()) document["buffers"] = {{{"byteLength", buffer.size()}}};
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<uint8_t> binary = buffer;
        binary.resize((binary.size() + 3) / 4 * 4);
        std::vector<uint8_t> bytes;
        put(bytes, 0x46546C67);
        put(bytes, 2);
        put(bytes, static_cast<uint32_t>(20 + text.size() + (binary.empty() ? 0 : 8 + binary.size())));
        put(bytes, static_cast<uint32_t>(text.size()));
        put(bytes, 0x4E4F534A);
        bytes.insert(bytes.end(), text.begin(), text.end());
        if (binary.empty()) return bytes;
        put(bytes, static_cast<uint32_t>(binary.size()));
        put(bytes, 0x004E4942);
        bytes.insert(bytes.end(), binary.begin(), binary.end());
        return bytes;
    }

    // bin: name of the .bin file that the text refers to; empty for a data URI.
    std::string gltf_text(const std::string& bin = "") const {
        nlohmann::json document = json;
        document["buffers"] = {
            {{"byteLength", buffer.size()},
             {"uri", bin.empty() ? "data:application/octet-stream;base64," + base64(buffer) : bin}}};
        return document.dump(1);
    }

    std::string write_glb(const std::string& path) const {
        write_file(path, glb_bytes());
        return path;
    }

    std::string write_gltf(const std::string& path) const {
        const std::string text = gltf_text();
        write_file(path, {text.begin(), text.end()});
        return path;
    }

  private:
    static int component_type(int8_t) { return 5120; }
    static int component_type(uint8_t) { return 5121; }
    static int component_type(int16_t) { return 5122; }
    static int component_type(uint16_t) { return 5123; }
    static int component_type(uint32_t) { return 5125; }
    static int component_type(float) { return 5126; }

    static void put(std::vector<uint8_t>& bytes, uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            bytes.push_back(static_cast<uint8_t>(value >> shift));
    }

    static std::string base64(const std::vector<uint8_t>& bytes) {
        const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (size_t i = 0; i < bytes.size(); i += 3) {
            uint32_t group = 0;
            for (size_t k = 0; k < 3; ++k)
                group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
            for (size_t k = 0; k < 4; ++k)
                text += k <= bytes.size() - i ? digits[group >> (18 - 6 * k) & 63] : '=';
        }
        return text;
    }
};

// PNG, 2 x 2, 8-bit RGB: red, green / blue, grey 128.
inline const std::vector<uint8_t> PNG_FOUR_COLORS{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xfd, 0xd4, 0x9a,
    0x73, 0x00, 0x00, 0x00, 0x13, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0xcf, 0xc0, 0xc0,
    0x00, 0xc2, 0x0c, 0xff, 0x1b, 0x1a, 0x1a, 0x00, 0x1c, 0xf4, 0x04, 0x7e, 0x9d, 0x71, 0x8c, 0x3d,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

// PNG, 1 x 1, 16-bit RGB: 0x8000, 0xffff, 0x0001.
inline const std::vector<uint8_t> PNG_16_BIT{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x10, 0x02, 0x00, 0x00, 0x00, 0xc0,
    0xe7, 0x8f, 0x9d, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x68,
    0x60, 0xf8, 0xff, 0x9f, 0x81, 0x11, 0x00, 0x0a, 0x01, 0x02, 0x80, 0xa7, 0xa9, 0xda, 0xcb,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

// A quad with everything that the reader follows: indices, normals, texture, sparse data, light, camera.
inline GltfBuilder rich_file() {
    GltfBuilder file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const int normals =
        file.accessor<int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC3", true);
    file.json["accessors"].back()["count"] = 4;
    file.json["bufferViews"][1]["byteStride"] = 4;
    const int uvs = file.accessor<uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 65535}, "VEC2", true);
    const int indices = file.accessor<uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    const std::vector<uint8_t> which{3};
    const std::vector<float> value{0, 1, 0.5f};
    const int index_view = file.view(which.data(), which.size());
    const int value_view = file.view(value.data(), 12);
    file.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", value_view}}}};
    const int image_view = file.view(PNG_FOUR_COLORS.data(), PNG_FOUR_COLORS.size());
    file.append("images", {{"bufferView", image_view}, {"mimeType", "image/png"}});
    file.append("samplers", {{"magFilter", 9728}, {"wrapS", 33071}});
    file.append("textures", {{"source", 0}, {"sampler", 0}});
    file.append("materials",
                {{"pbrMetallicRoughness",
                  {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                 {"emissiveFactor", {1, 1, 1}}});
    const int mesh = file.mesh({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}, indices,
                               {{"material", 0}});
    file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}});
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", nlohmann::json::object()}}};
    file.append("nodes", {{"mesh", mesh}, {"scale", {1, 2, -1}}});
    file.append("nodes", {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.append("nodes", {{"children", {0, 1}}, {"rotation", {0, 0, 0, 1}}});
    file.json["scenes"] = {{{"nodes", {2}}}};
    file.json["scene"] = 0;
    return file;
}

}  // namespace obscura::test
