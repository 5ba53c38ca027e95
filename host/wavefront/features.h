// SPDX-License-Identifier: Apache-2.0
// What a kernel is compiled with: the needs analysis turned into build options.
#pragma once

#include "scene/needs.h"
#include "wavefront/stages.h"

#include <string>

namespace obscura {

// Build options of a stage's kernel: "-D NEED_X=1" for each feature that it depends on and the scene needs.
// all: --needs all, which compiles every falloff too. portable: without intrinsics of one processor
// or streams of rays.
std::string stage_options(Stage stage, const Needs& needs, bool all, bool portable);

}  // namespace obscura
