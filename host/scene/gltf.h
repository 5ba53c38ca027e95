// SPDX-License-Identifier: Apache-2.0
// Reads glTF 2.0 (.gltf, .glb) into the scene model.
#pragma once

#include "scene/scene.h"

#include <filesystem>

namespace obscura {

// SCENE as users write it: a file, or a folder that holds one of its own name (scenes/kitchen means
// scenes/kitchen/kitchen.glb or .gltf). Throws InputError when there is none.
std::filesystem::path find_scene_file(const std::filesystem::path& path);

// Reads and validates. Throws InputError "file: place: what is wrong" (truncated, bad index, NaN vertex,
// unknown required extension). What is not supported is named in a warning, once per kind.
Scene load_gltf(const std::filesystem::path& file);

}  // namespace obscura
