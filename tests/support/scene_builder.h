// SPDX-License-Identifier: Apache-2.0
// Scenes built in code, under the name that tests use.
#pragma once

#include "reference/scene_builder.h"

namespace obscura::test {

using obscura::furnace_sphere;
using obscura::matte;
using obscura::metal;
using obscura::SceneBuilder;

}  // namespace obscura::test
