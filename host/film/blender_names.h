// SPDX-License-Identifier: Apache-2.0
// --exr-names blender: the channels are called as in Blender's multi-layer EXRs, so that its compositor, and what reads
// such files, find the passes they know.
#pragma once

#include "film/image.h"

namespace obscura {

// Renames a developed image's layers to "ViewLayer.<pass>", as the table in film/develop.h has the passes; beauty becomes
// BLENDER_BEAUTY.
void use_blender_names(Image& image);

}  // namespace obscura
