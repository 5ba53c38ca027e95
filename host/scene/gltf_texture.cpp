// SPDX-License-Identifier: Apache-2.0
// Decodes the images of textures (PNG and JPEG, through the stb_image inside tinygltf) to 8-bit RGBA.
#include "scene/gltf_reader.h"

#include <limits>
#include <span>

namespace obscura {

namespace {

// The encoded bytes of an image: read by tinygltf from its file or data URI, or a buffer view, checked here.
std::span<const unsigned char> encoded_image(const GltfReader& reader, const tinygltf::Image& image,
                                             const std::string& place) {
    if (image.bufferView < 0) {
        if (image.image.empty())
            reader.fail(place, "the image file '{}' is missing, empty or can't be read.", image.uri);
        return image.image;
    }
    const auto& views = reader.model.bufferViews;
    if (static_cast<size_t>(image.bufferView) >= views.size())
        reader.fail(place, "buffer view {} does not exist; the file has {}.", image.bufferView, views.size());
    const tinygltf::BufferView& view = views[static_cast<size_t>(image.bufferView)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= reader.model.buffers.size())
        reader.fail(place, "buffer {} does not exist; the file has {}.", view.buffer,
                    reader.model.buffers.size());
    const auto& data = reader.model.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        reader.fail(place, "its image reaches past the end of buffer {}.", view.buffer);
    return {data.data() + view.byteOffset, view.byteLength};
}

std::vector<uint8_t> to_8_bit(const std::vector<unsigned char>& bytes16) {
    std::vector<uint8_t> result(bytes16.size() / 2);
    for (size_t i = 0; i < result.size(); ++i) {
        // Little-endian 16-bit code, rounded to the nearest 8-bit one.
        const uint32_t code = bytes16[2 * i] | static_cast<uint32_t>(bytes16[2 * i + 1]) << 8;
        result[i] = static_cast<uint8_t>((code * 255 + 32767) / 65535);
    }
    return result;
}

Wrap wrap_mode(const GltfReader& reader, const std::string& place, int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirrored_repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp_to_edge;
        default:
            reader.fail(place, "its sampler has the unknown wrap mode {}.", mode);
    }
}

void set_sampler(GltfReader& reader, const std::string& place, int index, Texture& texture) {
    if (index < 0) return;  // glTF's default: repeat; the filter is free
    if (static_cast<size_t>(index) >= reader.model.samplers.size())
        reader.fail(place, "sampler {} does not exist; the file has {}.", index,
                    reader.model.samplers.size());
    const tinygltf::Sampler& sampler = reader.model.samplers[static_cast<size_t>(index)];
    texture.wrap_u = wrap_mode(reader, place, sampler.wrapS);
    texture.wrap_v = wrap_mode(reader, place, sampler.wrapT);
    texture.filter =
        sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? TextureFilter::nearest : TextureFilter::linear;
    const bool mipmaps = sampler.minFilter >= TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                         sampler.minFilter <= TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    if (mipmaps) reader.notices.add("mipmaps are not used; textures keep their full resolution", "texture");
}

Texture decode_texture(GltfReader& reader, int index, const std::string& owner) {
    const auto& textures = reader.model.textures;
    if (index < 0 || static_cast<size_t>(index) >= textures.size())
        reader.fail(owner, "texture {} does not exist; the file has {}.", index, textures.size());
    const tinygltf::Texture& source = textures[static_cast<size_t>(index)];
    const std::string place = fmt::format("{}: texture {}", owner, index);
    if (source.source < 0 || static_cast<size_t>(source.source) >= reader.model.images.size())
        reader.fail(place, "it has no PNG or JPEG image.");
    const tinygltf::Image& image = reader.model.images[static_cast<size_t>(source.source)];
    const std::span<const unsigned char> encoded = encoded_image(reader, image, place);
    if (encoded.size() > std::numeric_limits<int>::max())
        reader.fail(place, "images of 2 GiB or more are not supported.");

    tinygltf::Image decoded;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&decoded, source.source, &error, &warning, 0, 0, encoded.data(),
                                 static_cast<int>(encoded.size()), nullptr))
        reader.fail(
            place, "{}{} can't be decoded as PNG or JPEG.",
            gltf_place("image", image.name, static_cast<size_t>(source.source)),
            image.uri.empty() || image.uri.starts_with("data:") ? "" : fmt::format(" ({})", image.uri));
    Texture texture;
    texture.name = image.name.empty() ? image.uri : image.name;
    texture.width = static_cast<uint32_t>(decoded.width);
    texture.height = static_cast<uint32_t>(decoded.height);
    texture.rgba = decoded.bits == 16 ? to_8_bit(decoded.image) : std::move(decoded.image);
    OBSCURA_CHECK(texture.rgba.size() == size_t{4} * texture.width * texture.height, "{} x {} and {} bytes",
                  texture.width, texture.height, texture.rgba.size());
    set_sampler(reader, place, source.sampler, texture);
    return texture;
}

}  // namespace

int32_t use_texture(GltfReader& reader, int index, const std::string& owner) {
    const auto known = reader.textures.find(index);
    if (known != reader.textures.end()) return known->second;
    const auto slot = static_cast<int32_t>(reader.scene.textures.size());
    reader.scene.textures.push_back(decode_texture(reader, index, owner));
    reader.textures.emplace(index, slot);
    return slot;
}

V3d mean_texel(GltfReader& reader, int index, const std::string& owner, bool srgb) {
    const Texture texture = decode_texture(reader, index, owner);
    V3d sum(0, 0, 0);
    for (size_t i = 0; i < texture.rgba.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c) {
            const uint8_t code = texture.rgba[i + c];
            sum[static_cast<int>(c)] += srgb ? srgb_to_linear(code) : code / 255.0;
        }
    }
    return sum / (static_cast<double>(texture.width) * texture.height);
}

}  // namespace obscura
