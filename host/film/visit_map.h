// SPDX-License-Identifier: Apache-2.0
// Where rays are dear: the nodes of the tree that a pixel's rays visit, as a layer and as a picture.
#pragma once

#include "film/image.h"

#include <filesystem>
#include <vector>

namespace obscura {

inline constexpr const char* VISIT_LAYER = "visits";  // Y: nodes per sample, of all its rays

Layer visit_layer(std::vector<float> nodes_per_sample);

// Of what the picture shows, nodes per sample. One pixel in a hundred is brighter than the scale's end: a few pixels, as
// the edge of a thin thing seen through panes, would leave the rest in the dark.
struct VisitRange {
    double brightest = 0;  // the scale's end
    double most = 0;
};

// The pixels that the image has, in the colours of matplotlib's "magma", linearly from black for 0 to pale yellow; the bar below has the whole
// scale, from left to right. Atomic. Throws InputError.
VisitRange write_visit_map_png(const Image& image, const std::vector<float>& nodes_per_sample,
                               const std::filesystem::path& path);

}  // namespace obscura
