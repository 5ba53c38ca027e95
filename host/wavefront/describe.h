// SPDX-License-Identifier: Apache-2.0
// The header of a picture: what it shows, what shaped it, and how it was made (film/attributes.h).
#pragma once

#include "wavefront/render.h"

#include <string>

namespace obscura {

// Fills result.image.attributes from the rest of the result, which is complete.
void describe(const RenderJob& job, const std::string& device_name, RenderResult& result);

}  // namespace obscura
