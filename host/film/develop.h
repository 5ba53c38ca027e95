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

// Samples that the pixels of a range have, in the order of visits: those visited already may be some ahead.
struct SampleCounts {
    uint64_t passes = 0;  // that all pixels have
    uint64_t pixels_ahead = 0, passes_ahead = 0;

    uint64_t at(uint64_t place) const { return passes + (place < pixels_ahead ? passes_ahead : 0); }
};

// The sums of a film, or of some of its pixels: plane of each LAYER_* (NO_PLANE = not kept), plane * pixel_count + the pixel's
// place in the order of visits.
struct FilmSums {
    std::array<uint32_t, LAYER_COUNT> planes;
    std::span<const FilmSum> sums;
    std::span<const uint32_t> pixel_order;  // the pixel that has each place, counted in rows
    SampleCounts samples;
    size_t first_pixel = 0;  // of the image: the one that pixel_order calls 0
};

// Black layers for the image's pixels: beauty, then the wanted ones by name. Names not in the table: OBSCURA_CHECK.
void add_layers(std::span<const std::string> wanted, Image& image);

// Puts the film's pixels into these layers: beauty is the sum of the layers that partition it, alpha = coverage. Of the others
// those that are not kept stay black, and so do pixels without a sample.
void develop(const FilmSums& film, Image& image);

}  // namespace obscura
