// SPDX-License-Identifier: Apache-2.0
// Falloffs that tests go through.
#pragma once

#include <vector>

#include "scene/settings.h"

namespace obscura::test {

inline const Falloff STEP{FalloffKind::step, 1};
inline const Falloff LINEAR{FalloffKind::linear, 1};
inline const Falloff SQRT{FalloffKind::sqrt, 1};
inline const Falloff EXP{FalloffKind::exp, 1};
inline const std::vector<Falloff> MAIN_FALLOFFS{STEP, LINEAR, SQRT, EXP};
// Every kind, and both sides of its parameter's default; 2 is where closed forms of pow have a limit.
inline const std::vector<Falloff> ALL_FALLOFFS{STEP,
                                               LINEAR,
                                               SQRT,
                                               EXP,
                                               {FalloffKind::exp, 5},
                                               {FalloffKind::cbrt, 1},
                                               {FalloffKind::expjump, 1},
                                               {FalloffKind::pow, 0.25},
                                               {FalloffKind::pow, 2}};

}  // namespace obscura::test
