// SPDX-License-Identifier: Apache-2.0
// Develops the film: sums of samples become the picture's layers.
#pragma once

#include "film/image.h"
#include "shared/types.h"
#include "shared/wavefront.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace obscura {

// Names of the layers as users write them for --layers and find them in the file.
struct LayerInfo {
    uint32_t layer;  // LAYER_*
    const char* name;
    std::vector<std::string> channels;
    const char* blender_pass;                   // of --exr-names blender
    std::vector<std::string> blender_channels;  // those beyond the layer's own repeat its first
    const char* meaning;
};
const std::vector<LayerInfo>& layer_table();
const LayerInfo& layer_info(const std::string& name);  // names not in the table: OBSCURA_CHECK

// The sums of one film: plane of each LAYER_* (NO_PLANE = not kept), plane * pixel_count + the pixel's place in the order
// of visits.
struct FilmSums {
    std::array<uint32_t, LAYER_COUNT> planes;
    std::span<const FilmSum> sums;
    std::span<const uint32_t> pixel_order;  // the pixel that has each place, counted in rows
    // Samples that each pixel has: the first pixels_ahead pixels in that order have one more than the others.
    uint64_t samples = 0;
    uint64_t pixels_ahead = 0;
};

// Appends the rows of a film band to the image's layers, making the layers on the first call: beauty (the sum of the
// layers that partition it, alpha = coverage), then the wanted layers by name; one that is not kept is black. Pixels without a
// sample stay 0. Names not in the table: OBSCURA_CHECK.
void develop_band(const FilmSums& film, std::span<const std::string> wanted, Image& image);

}  // namespace obscura
