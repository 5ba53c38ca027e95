// SPDX-License-Identifier: Apache-2.0
// The colour map of false-colour pictures. Internal to film.
#pragma once

#include "film/png.h"

namespace obscura {

// place: 0..1 along matplotlib's "magma", from black to pale yellow.
Rgb8 magma(double place);

}  // namespace obscura
