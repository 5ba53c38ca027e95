// SPDX-License-Identifier: Apache-2.0
// From bytes on disk to tinygltf's model. tinygltf 2.7 trusts some lengths of a .glb (it can read past the
// end), recurses without limit, expands shell syntax in URIs and looks for resources in the current folder
// too; the checks and callbacks here take that away.
#include "base/file.h"
#include "base/units.h"
#include "scene/gltf_reader.h"

#include <cstring>
#include <limits>
#include <string_view>

namespace obscura {

namespace {

constexpr uint32_t GLB_MAGIC = 0x46546C67;       // "glTF"
constexpr uint32_t GLB_CHUNK_JSON = 0x4E4F534A;  // "JSON"
constexpr size_t GLB_HEADER_BYTES = 12;
constexpr size_t GLB_CHUNK_HEADER_BYTES = 8;
// Real files nest about ten deep. tinygltf recurses through extensions and extras.
constexpr int MAX_JSON_DEPTH = 200;
constexpr size_t SHORTEST_JSON = 4;  // bytes; tinygltf looks at no less, not even at "{}"
constexpr std::string_view MISSING_FILE = "File not found : ";  // tinygltf's words

uint32_t load_u32(const std::vector<std::byte>& bytes, size_t offset) {
    uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

bool is_binary(const std::vector<std::byte>& bytes) {
    return bytes.size() >= 4 && load_u32(bytes, 0) == GLB_MAGIC;
}

// Checks that header and chunks of a .glb lie inside the file. Returns the length of the JSON chunk.
size_t check_glb(const std::string& file, const std::vector<std::byte>& bytes) {
    if (bytes.size() < GLB_HEADER_BYTES + GLB_CHUNK_HEADER_BYTES)
        throw InputError("{}: header: the file is truncated; {} bytes are too few for a .glb.", file,
                         bytes.size());
    const uint32_t version = load_u32(bytes, 4);
    if (version != 2)
        throw InputError("{}: header: this is version {} of binary glTF; only version 2 is read.", file,
                         version);
    const size_t length = load_u32(bytes, 8);
    if (length > bytes.size())
        throw InputError("{}: header: the file is truncated; it should have {} bytes and has {}.", file,
                         length, bytes.size());
    size_t json_bytes = 0;
    size_t chunk_count = 0;
    for (size_t offset = GLB_HEADER_BYTES; offset < length; ++chunk_count) {
        if (length - offset < GLB_CHUNK_HEADER_BYTES)
            throw InputError("{}: chunk {}: its header is cut off.", file, chunk_count);
        const size_t chunk_bytes = load_u32(bytes, offset);
        if (chunk_bytes > length - offset - GLB_CHUNK_HEADER_BYTES)
            throw InputError("{}: chunk {}: with its {} it reaches past the end of the file.", file,
                             chunk_count, counted(chunk_bytes, "byte"));
        if (chunk_count == 0) {
            if (load_u32(bytes, offset + 4) != GLB_CHUNK_JSON)
                throw InputError("{}: chunk 0: it is not the JSON chunk.", file);
            json_bytes = chunk_bytes;
        }
        offset += GLB_CHUNK_HEADER_BYTES + chunk_bytes;
    }
    return json_bytes;
}

void check_json_depth(const std::string& file, const std::byte* json, size_t size) {
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < size; ++i) {
        const char c = static_cast<char>(json[i]);
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > MAX_JSON_DEPTH)
                throw InputError("{}: JSON: nested more than {} levels deep.", file, MAX_JSON_DEPTH);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

// Images are kept as they are in the file; gltf_texture.cpp decodes those that are used.
bool keep_encoded_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                        const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

tinygltf::FsCallbacks file_callbacks() {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& path, void*) {
        std::error_code ignored;
        return std::filesystem::path(path).is_absolute() && std::filesystem::is_regular_file(path, ignored);
    };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error, const std::string& path,
                                 void*) {
        try {
            const std::vector<std::byte> bytes = read_bytes(path);
            out->resize(bytes.size());
            if (!bytes.empty()) std::memcpy(out->data(), bytes.data(), bytes.size());
            return true;
        } catch (const InputError& failure) {
            *error = failure.what();
            return false;
        }
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                  void*) { return false; };
    return callbacks;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

// tinygltf's messages, one per line, as one sentence. It calls a skin's inverse bind matrices required,
// which they are not, and passes on the names that its JSON library gives to errors.
std::string errors_in_one_line(std::string text) {
    replace_all(text, "'inverseBindMatrices' property is missing in Skin.\n", "");
    replace_all(text, "\"asset\" object not found in .gltf or not an object type", "it has no asset object.");
    if (const size_t end = text.find("] "); text.starts_with("[json.exception.") && end != std::string::npos)
        text.erase(0, end + 2);
    std::string line;
    for (const char c : text)
        line += c == '\n' ? ' ' : c;
    while (line.ends_with(' '))
        line.pop_back();
    return line;
}

}  // namespace

tinygltf::Model read_gltf_model(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::vector<std::byte> bytes = read_bytes(path);
    if (bytes.empty()) throw InputError("{}: the file is empty.", file);
    if (bytes.size() > std::numeric_limits<uint32_t>::max())
        throw InputError("{}: header: glTF files of 4 GiB or more are not supported.", file);
    const bool binary = is_binary(bytes);
    const size_t json_offset = binary ? GLB_HEADER_BYTES + GLB_CHUNK_HEADER_BYTES : 0;
    const size_t json_bytes = binary ? check_glb(file, bytes) : bytes.size();
    check_json_depth(file, bytes.data() + json_offset, json_bytes);
    if (!binary && bytes.size() < SHORTEST_JSON) bytes.resize(SHORTEST_JSON, std::byte{' '});

    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(file_callbacks());
    loader.SetImageLoader(keep_encoded_image, nullptr);
    tinygltf::Model model;
    std::string error, warning;  // the warnings are about unreadable images, which matter only when used
    bool loaded = false;
    try {
        const std::string folder = std::filesystem::absolute(path).parent_path().string();
        const auto size = static_cast<unsigned>(bytes.size());
        loaded = binary
                     ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                                   reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                                   folder)
                     : loader.LoadASCIIFromString(&model, &error, &warning,
                                                  reinterpret_cast<const char*>(bytes.data()), size, folder);
    } catch (const std::exception& failure) {
        error = failure.what();
    }
    error = errors_in_one_line(error);
    if (loaded && error.empty()) return model;
    if (error.starts_with(MISSING_FILE))
        throw InputError("{}: the file {} that it needs is missing.", file,
                         error.substr(MISSING_FILE.size()));
    throw InputError("{}: not a valid glTF file: {}", file,
                     error.empty() ? "its structure is broken." : error);
}

}  // namespace obscura
