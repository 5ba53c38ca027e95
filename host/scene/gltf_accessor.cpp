// SPDX-License-Identifier: Apache-2.0
// Bounds checks and component conversion of accessors: glTF 2.0 specification, sections 3.6 and 5.1.
#include "scene/gltf_accessor.h"

#include "base/units.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace obscura {

namespace {

template <typename T>
T load(const unsigned char* address) {
    T value;
    std::memcpy(&value, address, sizeof value);
    return value;
}

// Bytes of one component; 0 for types that glTF 2.0 does not have.
size_t component_size(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

uint32_t load_unsigned(int component_type, const unsigned char* address) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<uint8_t>(address);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<uint16_t>(address);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(address);
        default:
            OBSCURA_CHECK(false, "component type {} is no index type", component_type);
    }
}

bool is_unsigned(int component_type) {
    return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

AccessorView::AccessorView(const GltfReader& reader, int accessor_index, const std::string& place) {
    const auto& accessors = reader.model.accessors;
    if (accessor_index < 0 || static_cast<size_t>(accessor_index) >= accessors.size())
        reader.fail(place, "accessor {} does not exist; the file has {}.", accessor_index, accessors.size());
    const tinygltf::Accessor& accessor = accessors[static_cast<size_t>(accessor_index)];
    const std::string where = fmt::format("{}: accessor {}", place, accessor_index);
    component_type_ = accessor.componentType;
    component_bytes_ = component_size(component_type_);
    components_ = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    normalized_ = accessor.normalized;
    count_ = accessor.count;
    if (component_bytes_ == 0 || components_ < 1)
        reader.fail(where, "its component type {} is not one of glTF's.", component_type_);
    if (count_ > std::numeric_limits<uint32_t>::max())
        reader.fail(where, "{} elements are more than 32-bit indices reach.", count_);
    if (accessor.bufferView < 0)
        reader.fail(where, "it has no buffer view; accessors without one are not supported.");
    base_ = checked_region(reader, where, accessor.bufferView, accessor.byteOffset, count_,
                           component_bytes_ * static_cast<size_t>(components_));
    if (accessor.sparse.isSparse) read_sparse(reader, where, accessor);
}

AccessorView::Region AccessorView::checked_region(const GltfReader& reader, const std::string& place,
                                                  int view_index, size_t offset, size_t count,
                                                  size_t element_bytes) const {
    const auto& views = reader.model.bufferViews;
    if (view_index < 0 || static_cast<size_t>(view_index) >= views.size())
        reader.fail(place, "buffer view {} does not exist; the file has {}.", view_index, views.size());
    const tinygltf::BufferView& view = views[static_cast<size_t>(view_index)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= reader.model.buffers.size())
        reader.fail(place, "buffer {} does not exist; the file has {}.", view.buffer,
                    reader.model.buffers.size());
    const auto& data = reader.model.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        reader.fail(place, "buffer view {} ends at byte {} + {}, but its buffer has {}.", view_index,
                    view.byteOffset, view.byteLength, counted(data.size(), "byte"));
    const size_t stride = view.byteStride == 0 ? element_bytes : view.byteStride;
    if (stride < element_bytes)
        reader.fail(place, "elements of {} overlap at a stride of {}.", counted(element_bytes, "byte"),
                    stride);
    // Written so that nothing can overflow: count * stride + element_bytes <= available.
    const size_t available = view.byteLength - std::min(offset, view.byteLength);
    const bool fits =
        count == 0 || (available >= element_bytes && (available - element_bytes) / stride >= count - 1);
    if (offset > view.byteLength || !fits)
        reader.fail(place, "buffer view {} of {} has no room for {} of {} from byte {}.", view_index,
                    counted(view.byteLength, "byte"), counted(count, "element"),
                    counted(element_bytes, "byte"), offset);
    return {data.data() + view.byteOffset + offset, stride};
}

void AccessorView::read_sparse(const GltfReader& reader, const std::string& place,
                               const tinygltf::Accessor& accessor) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        reader.fail(place, "its sparse part has a negative count or offset.");
    if (!is_unsigned(sparse.indices.componentType))
        reader.fail(place, "its sparse indices have the component type {}, not an unsigned integer.",
                    sparse.indices.componentType);
    const auto count = static_cast<size_t>(sparse.count);
    const Region indices = checked_region(reader, place, sparse.indices.bufferView,
                                          static_cast<size_t>(sparse.indices.byteOffset), count,
                                          component_size(sparse.indices.componentType));
    const Region values =
        checked_region(reader, place, sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset),
                       count, component_bytes_ * static_cast<size_t>(components_));
    for (size_t i = 0; i < count; ++i) {
        const uint32_t element =
            load_unsigned(sparse.indices.componentType, indices.data + i * indices.stride);
        if (element >= count_)
            reader.fail(place, "sparse index {} is outside its {}.", element, counted(count_, "element"));
        sparse_[element] = values.data + i * values.stride;
    }
}

const unsigned char* AccessorView::element_address(size_t element) const {
    OBSCURA_CHECK(element < count_, "element {} of {}", element, count_);
    if (!sparse_.empty()) {
        const auto found = sparse_.find(element);
        if (found != sparse_.end()) return found->second;
    }
    return base_.data + element * base_.stride;
}

double AccessorView::value(size_t element, int component) const {
    OBSCURA_CHECK(component >= 0 && component < components_, "component {} of {}", component, components_);
    const unsigned char* address =
        element_address(element) + component_bytes_ * static_cast<size_t>(component);
    // Integer to real as in section 3.11 of the specification.
    const auto unsigned_value = [&](double code, double largest) {
        return normalized_ ? code / largest : code;
    };
    const auto signed_value = [&](double code, double largest) {
        return normalized_ ? std::max(code / largest, -1.0) : code;
    };
    switch (component_type_) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return signed_value(load<int8_t>(address), 127);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return unsigned_value(load<uint8_t>(address), 255);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return signed_value(load<int16_t>(address), 32767);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return unsigned_value(load<uint16_t>(address), 65535);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(address);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return static_cast<double>(load<float>(address));
        default:
            OBSCURA_CHECK(false, "component type {}", component_type_);
    }
}

uint32_t AccessorView::index(size_t element) const {
    return load_unsigned(component_type_, element_address(element));
}

}  // namespace obscura
