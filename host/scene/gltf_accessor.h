// SPDX-License-Identifier: Apache-2.0
// A checked view of a glTF accessor: after construction every element that it can return lies inside its
// buffer, whatever the file says. Private to the glTF reader.
#pragma once

#include "scene/gltf_reader.h"

#include <cstddef>
#include <unordered_map>

namespace obscura {

class AccessorView {
  public:
    // place: "mesh 'x' primitive 0: POSITION". Throws InputError if anything doesn't fit.
    AccessorView(const GltfReader& reader, int accessor, const std::string& place);

    size_t count() const { return count_; }
    int components() const { return components_; }
    int component_type() const { return component_type_; }

    // Normalised integers become [0, 1] or [-1, 1].
    double value(size_t element, int component) const;
    // For indices: unsigned integer components only.
    uint32_t index(size_t element) const;

  private:
    struct Region {
        const unsigned char* data = nullptr;
        size_t stride = 0;  // bytes
    };
    Region checked_region(const GltfReader& reader, const std::string& place, int buffer_view, size_t offset,
                          size_t count, size_t element_bytes) const;
    void read_sparse(const GltfReader& reader, const std::string& place, const tinygltf::Accessor& accessor);
    const unsigned char* element_address(size_t element) const;

    Region base_;
    size_t count_ = 0;
    int components_ = 0;
    int component_type_ = 0;
    size_t component_bytes_ = 0;
    bool normalized_ = false;
    std::unordered_map<size_t, const unsigned char*> sparse_;  // replaced elements
};

}  // namespace obscura
