// SPDX-License-Identifier: Apache-2.0
#include "film/develop.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "shared/frame.h"

namespace obscura {
namespace {

constexpr size_t PLACES_AT_ONCE = 4096;  // some tens of microseconds for a thread

// Component of a f32x4 by index.
float component(const f32x4& v, size_t i) {
    return i == 0 ? v.x : i == 1 ? v.y : i == 2 ? v.z : v.w;
}

class Developer {
  public:
    Developer(const FilmSums& film, size_t pixel_count) : film_(film), pixel_count_(pixel_count) {}

    // Mean of a layer at a place; 0 where the layer isn't kept.
    f32x4 mean(uint32_t layer, size_t place) const {
        const uint64_t n = film_.samples.at(place);
        return n == 0 ? f32x4{} : quotient(layer, place, n);
    }

    // Sum of the layers that partition it; w: coverage.
    f32x4 beauty(size_t place) const {
        f32x4 total = mean(LAYER_EMISSION, place);
        for (uint32_t layer = LAYER_EMISSION + 1; layer < BEAUTY_LAYERS; ++layer) {
            const f32x4 value = mean(layer, place);
            total = {total.x + value.x, total.y + value.y, total.z + value.z, total.w};
        }
        return total;
    }

    // Of the samples, without bias; 0 where there are fewer than two.
    f32x4 variance(size_t place) const {
        const uint64_t n = film_.samples.at(place);
        return n < 2 ? f32x4{} : quotient(LAYER_VARIANCE, place, n - 1);
    }

    // As pbrt-v4 has it: the variance over the mean, 0 where that is 0.
    f32x4 relative_variance(size_t place) const {
        const f32x4 v = variance(place);
        const f32x4 m = beauty(place);
        const auto over = [](float a, float b) { return b != 0 ? a / b : 0; };
        return {over(v.x, m.x), over(v.y, m.y), over(v.z, m.z), 0};
    }

  private:
    // A layer's sum over a count, rounded once.
    f32x4 quotient(uint32_t layer, size_t place, uint64_t count) const {
        const uint32_t plane = film_.planes[layer];
        if (plane == NO_PLANE) return {};
        const auto& [sum, excess] = film_.sums[size_t{plane} * pixel_count_ + place];
        const auto over = [count](float s, float e) {
            return static_cast<float>((static_cast<double>(s) - static_cast<double>(e)) /
                                      static_cast<double>(count));
        };
        return {over(sum.x, excess.x), over(sum.y, excess.y), over(sum.z, excess.z), over(sum.w, excess.w)};
    }

    const FilmSums& film_;
    size_t pixel_count_;
};

// First component of the layer's value that the channels start at: v is the second, ao.Y and Z live in the fourth.
size_t first_component(const std::string& name) {
    if (name == "v") return 1;
    return name == "ao" || name == "Z" ? 3 : 0;
}

}  // namespace

const std::vector<LayerInfo>& layer_table() {
    static const std::vector<std::string> rgb{"R", "G", "B"};
    static const std::vector<std::string> xyz{"X", "Y", "Z"};
    // Blender's pass names (those of 2.80 to 4.5) where it has a pass of that content or nearly so, our own elsewhere: its
    // DiffDir, for one, is without the albedo that direct holds. Its Emit is without the sky and its DiffCol without the
    // specular albedo; ours stand in for them. Its Normal is the shading normal.
    // AO is R, G and B: so Blender writes this grey pass, and readers ask for all three.
    static const std::vector<LayerInfo> table{
        {LAYER_EMISSION, "emission", rgb, "Emit", rgb, "lights and sky seen directly"},
        {LAYER_DIRECT, "direct", rgb, "Direct", rgb, "diffuse light straight from the lights"},
        {LAYER_AMBIENT, "ambient", rgb, "Ambient", rgb, "R_d W I_A: the obscurances"},
        {LAYER_SPECULAR_EMISSION, "specular.emission", rgb, "SpecularEmission", rgb,
         "lights and sky seen in reflections and through panes"},
        {LAYER_SPECULAR_DIRECT, "specular.direct", rgb, "SpecularDirect", rgb,
         "direct light seen in reflections and through panes"},
        {LAYER_SPECULAR_AMBIENT, "specular.ambient", rgb, "SpecularAmbient", rgb,
         "obscurances seen in reflections and through panes"},
        {LAYER_OBSCURANCE, "obscurance", rgb, "Obscurance", rgb, "W at the first hit with a diffuse part"},
        {LAYER_OBSCURANCE, "ao", {"Y"}, "AO", rgb, "colourless W of the same rays: 1 open, 0 closed"},
        {LAYER_POSITION, "P", xyz, "Position", xyz, "position of the first hit, m"},
        {LAYER_POSITION, "Z", {"Z"}, "Depth", {"Z"}, "distance along the camera's axis, m"},
        {LAYER_NORMAL, "N", xyz, "GeometricNormal", xyz,
         "geometric normal of the first hit, towards the camera"},
        {LAYER_SHADING, "Ns", xyz, "Normal", xyz, "shading normal of the first hit, towards the camera"},
        {LAYER_UV, "u", {"u"}, "UV", {"U"}, "texture coordinate of the first hit"},
        {LAYER_UV, "v", {"v"}, "UV", {"V"}, "texture coordinate of the first hit"},
        {LAYER_ALBEDO, "Albedo", rgb, "DiffCol", rgb, "diffuse + specular albedo of the first hit"},
        {LAYER_VARIANCE, "Variance", rgb, "Variance", rgb, "variance of the samples of a pixel"},
        {LAYER_VARIANCE, "RelativeVariance", rgb, "RelativeVariance", rgb, "that over the pixel's mean"},
    };
    return table;
}

const LayerInfo& layer_info(const std::string& name) {
    const auto& table = layer_table();
    const auto found = std::ranges::find_if(table, [&](const LayerInfo& info) { return name == info.name; });
    OBSCURA_CHECK(found != table.end(), "no layer is called '{}'", name);
    return *found;
}

void add_layers(std::span<const std::string> wanted, Image& image) {
    const auto add = [&](const std::string& name, const std::vector<std::string>& channels) {
        image.layers.push_back({name, channels, std::vector<float>(image.pixel_count() * channels.size())});
    };
    add("", {"R", "G", "B", "A"});
    for (const std::string& name : wanted)
        add(name, layer_info(name).channels);
}

void develop(const FilmSums& film, Image& image) {
    const size_t planes = static_cast<size_t>(
        std::ranges::count_if(film.planes, [](uint32_t plane) { return plane != NO_PLANE; }));
    OBSCURA_CHECK(planes > 0 && film.sums.size() % planes == 0, "{} sums in {} planes", film.sums.size(),
                  planes);
    const size_t pixel_count = film.sums.size() / planes;
    OBSCURA_CHECK(film.pixel_order.size() == pixel_count, "{} places for {} pixels", film.pixel_order.size(),
                  pixel_count);
    const Developer developer(film, pixel_count);

    // value_at: of a place in the order of visits.
    const auto fill = [&](Layer& layer, size_t first, auto value_at) {
        const size_t channels = layer.channels.size();
        const auto fill_range = [&](const tbb::blocked_range<size_t>& places) {
            for (size_t place = places.begin(); place < places.end(); ++place) {
                const f32x4 value = value_at(place);
                float* const pixel = &layer.pixels[(film.first_pixel + film.pixel_order[place]) * channels];
                for (size_t c = 0; c < channels; ++c)
                    pixel[c] = component(value, first + c);
            }
        };
        tbb::parallel_for(tbb::blocked_range<size_t>(0, pixel_count, PLACES_AT_ONCE), fill_range);
    };
    for (Layer& layer : image.layers) {
        if (layer.name.empty()) {
            fill(layer, 0, [&](size_t place) { return developer.beauty(place); });
        } else if (layer.name == "Variance") {
            fill(layer, 0, [&](size_t place) { return developer.variance(place); });
        } else if (layer.name == "RelativeVariance") {
            fill(layer, 0, [&](size_t place) { return developer.relative_variance(place); });
        } else {
            const uint32_t kept = layer_info(layer.name).layer;
            fill(layer, first_component(layer.name),
                 [&](size_t place) { return developer.mean(kept, place); });
        }
    }
}

}  // namespace obscura
