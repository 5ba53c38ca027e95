// SPDX-License-Identifier: Apache-2.0
// The header of a picture: what it shows, what shaped it, and how it was made (film/attributes.h).
#pragma once

#include "wavefront/plan.h"
#include "wavefront/render.h"

#include <string>

namespace obscura {

// The whole picture's size, and the pixels that the image has of it.
void place_image(Image& image, const RenderSettings& settings, const PixelRect& rect);

// Fills result.image.attributes from the rest of the result, which is complete.
void describe(const RenderJob& job, const std::string& device_name, RenderResult& result);

}  // namespace obscura
