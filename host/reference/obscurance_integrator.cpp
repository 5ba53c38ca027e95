// SPDX-License-Identifier: Apache-2.0
// The model of the kernels shade, shadow, obscurance and gather, one path at a time:
//   L = emission + direct light + R_d W I_A + L at the next hit of a reflected or transmitted ray
// (Mendez, Sbert, Neumann 2003). What they compute is written down anew here; only the choice of the random numbers'
// dimensions, and what each number decides, follows them.
#include "reference/integrator.h"

#include <cmath>
#include <optional>

namespace obscura::reference {
namespace {

// A path on its way.
struct PathState {
    Ray ray;
    RgbD throughput{1, 1, 1};
    // Of the last glossy direction, 0 = camera or mirror, and where it was drawn. Passing a pane leaves both as they are,
    // since shadow rays see through panes too.
    double pdf_sr = 0;
    V3d scattered_at{0, 0, 0};
    uint32_t depth = 0;
};

// A surface on the path, with the path as it arrived.
struct Vertex {
    const PathState& path;
    Surface surface;
    Bsdf bsdf;
};

class ObscuranceIntegrator : public Integrator {
  public:
    ObscuranceIntegrator(const World& world, const RenderSettings& settings, const Radiometry& radiometry,
                         double d_max);

    PathLight estimate(const Ray& camera_ray, const PathSampler& sampler) const override;

  private:
    double emission_weight(const PathState& path, const Surface& surface) const;
    void add_lights(const Vertex& vertex, const PathSampler& sampler, PathLight& light) const;
    void add_light(const Vertex& vertex, const LightSample& sample, PathLight& light) const;
    bool is_followed(uint32_t depth) const { return settings_.specular && depth < settings_.max_depth; }
    RgbD obscurance(const Vertex& vertex, const PathSampler& sampler) const;
    RgbD obscurance_along(const Vertex& vertex, const V3d& direction) const;
    std::optional<PathState> continuation(const Vertex& vertex, const PathSampler& sampler) const;

    const World& world_;
    const RenderSettings settings_;
    double d_max_;
    bool ambient_, traced_, bleeding_;
    RgbD ambient_light_;  // I_A
    RgbD open_;           // what an open direction contributes to W
};

ObscuranceIntegrator::ObscuranceIntegrator(const World& world, const RenderSettings& settings,
                                           const Radiometry& radiometry, double d_max)
    : world_(world),
      settings_(settings),
      d_max_(d_max),
      ambient_(settings.obscurance && settings.ambient != Ambient::none),
      traced_(ambient_ && settings.ambient == Ambient::obscurance),
      bleeding_(traced_ && settings.bleeding),
      ambient_light_(resolve_ambient(radiometry, settings)),
      open_(bleeding_ ? radiometry.average_reflectivity : RgbD(1)) {}

PathLight ObscuranceIntegrator::estimate(const Ray& camera_ray, const PathSampler& sampler) const {
    PathLight light;
    bool obscurance_seen = false;
    std::optional<PathState> path = PathState{camera_ray};
    while (path) {
        const bool first = path->depth == 0;
        ++light.rays;
        RgbD& emission = light.parts[first ? LAYER_EMISSION : LAYER_SPECULAR_EMISSION];
        const Hit hit = world_.tracer.nearest(path->ray);
        if (!hit.found()) {
            emission += path->throughput * world_.background;
            return light;
        }
        if (first) light.coverage = 1;
        const Surface surface = world_.surfaces.surface_at(hit, path->ray.direction);
        if (surface.material->unlit) {
            emission += path->throughput * surface.base;
            return light;
        }
        emission += path->throughput * surface.emitted() * emission_weight(*path, surface);
        const Vertex vertex{*path, surface, Bsdf(surface, path->ray.direction)};
        add_lights(vertex, sampler, light);
        if (ambient_ && max_component(vertex.bsdf.diffuse()) > 0) {
            RgbD w(1);
            if (traced_) {
                w = obscurance(vertex, sampler);
                light.rays += settings_.obscurance_rays;
                if (!obscurance_seen) light.obscurance = w;
                obscurance_seen = true;
            }
            light.parts[first ? LAYER_AMBIENT : LAYER_SPECULAR_AMBIENT] +=
                path->throughput * vertex.bsdf.diffuse() * ambient_light_ * w;
        }
        path = continuation(vertex, sampler);
    }
    return light;
}

// Of emission that a glossy ray found by itself, against the light samples that could have found it.
double ObscuranceIntegrator::emission_weight(const PathState& path, const Surface& surface) const {
    if (path.pdf_sr == 0) return 1;
    const double distance = (surface.position - path.scattered_at).length();
    const double light_pdf =
        world_.lights.area_pdf_sr(surface.primitive, path.scattered_at, path.ray.direction, distance);
    return power_heuristic(path.pdf_sr, settings_.light_samples * light_pdf);
}

void ObscuranceIntegrator::add_lights(const Vertex& vertex, const PathSampler& sampler,
                                      PathLight& light) const {
    const uint32_t depth = vertex.path.depth;
    const SampleSet choices = sampler.light_points(depth, Dimension::select_light);
    const SampleSet points = sampler.light_points(depth, Dimension::area_light);
    const V3d& position = vertex.surface.position;
    for (uint32_t l = 0; l < settings_.light_samples; ++l) {
        const V2d choice = choices.exact(l);
        if (world_.lights.has_area_lights())
            add_light(vertex, world_.lights.sample_area(position, points[l], choice.x), light);
        if (world_.lights.has_punctual_lights())
            add_light(vertex, world_.lights.sample_punctual(position, choice.y), light);
    }
}

// Through both lobes, if the light is seen.
void ObscuranceIntegrator::add_light(const Vertex& vertex, const LightSample& sample,
                                     PathLight& light) const {
    const Bsdf& bsdf = vertex.bsdf;
    const double cosine = sample.direction.dot(bsdf.n_shade());
    if (cosine <= 0 || sample.direction.dot(vertex.surface.n_geo) <= 0) return;
    if (!(max_component(sample.radiance) > 0)) return;
    const RgbD arriving = vertex.path.throughput * sample.radiance * (cosine / settings_.light_samples);
    RgbD diffuse(0), glossy(0);
    if (settings_.direct) diffuse = arriving * bsdf.diffuse() / std::numbers::pi;
    if (settings_.specular && bsdf.is_glossy()) {
        const LobeValue lobe = bsdf.glossy(sample.direction);
        const bool shared = sample.pdf_sr > 0 && is_followed(vertex.path.depth);
        glossy = arriving * lobe.brdf *
                 (shared ? power_heuristic(settings_.light_samples * sample.pdf_sr, lobe.pdf_sr) : 1.0);
    }
    if (!(max_component(diffuse + glossy) > 0)) return;
    ++light.rays;
    const RgbD seen = world_.transmittance(vertex.surface, sample);
    light.parts[vertex.path.depth == 0 ? LAYER_DIRECT : LAYER_SPECULAR_DIRECT] += diffuse * seen;
    light.parts[LAYER_SPECULAR_EMISSION] += glossy * seen;
}

// W of equations (2) and (6): the mean over the K cosine-distributed rays.
RgbD ObscuranceIntegrator::obscurance(const Vertex& vertex, const PathSampler& sampler) const {
    const SampleSet directions = sampler.obscurance_directions(vertex.path.depth);
    const Basis basis(vertex.bsdf.n_shade());
    RgbD sum(0);
    for (uint32_t k = 0; k < settings_.obscurance_rays; ++k) {
        const V3d direction = basis.to_world(cosine_hemisphere(directions[k]));
        sum += obscurance_along(vertex, reflect_above(direction, vertex.surface.n_geo).normalized());
    }
    return sum / settings_.obscurance_rays;
}

// R(Q) rho(d) of what the ray meets within d_max, or what an open direction counts. Panes dim what is behind them; d is
// measured from the point itself.
RgbD ObscuranceIntegrator::obscurance_along(const Vertex& vertex, const V3d& direction) const {
    const V3d& from = vertex.surface.position;
    V3d origin = from + vertex.surface.lift;
    RgbD through(1), w(0);
    for (uint32_t panes = 0;; ++panes) {
        const Hit hit = world_.tracer.nearest({origin, direction, d_max_});
        if (!hit.found()) break;
        const Surface met = world_.surfaces.surface_at(hit, direction);
        const double distance = (met.position - from).length();
        if (distance >= d_max_) break;
        const double rho = falloff_value(settings_.falloff, std::isinf(d_max_) ? 0 : distance / d_max_);
        const RgbD reflectivity = bleeding_ ? met.mean_reflectivity() : RgbD(1);
        if (!met.material->pane || panes == MAX_PANES) return w + rho * through * reflectivity;
        const RgbD passed = World::pane_transmittance(met, direction);
        w += rho * through * (RgbD(1) - passed) * reflectivity;
        through *= passed;
        origin = met.position - met.lift;
    }
    return w + through * open_;
}

// The reflected or transmitted ray that goes on, if one does.
std::optional<PathState> ObscuranceIntegrator::continuation(const Vertex& vertex,
                                                            const PathSampler& sampler) const {
    const auto& [path, surface, bsdf] = vertex;
    if (!is_followed(path.depth)) return std::nullopt;
    const V2d choice = sampler.point(path.depth, Dimension::lobe);
    PathState next;
    next.depth = path.depth + 1;
    next.scattered_at = surface.position;
    LobeSample sample;
    double albedo = 0;  // of everything that may be followed
    V3d lift = surface.lift;
    if (bsdf.is_pane()) {
        const auto [reflected, passed] = bsdf.pane();
        const double p_reflect =
            mean_component(reflected) / (mean_component(reflected) + mean_component(passed));
        albedo = max_component(reflected + passed);
        if (choice.x < p_reflect) {
            sample = bsdf.mirror();
            sample.weight = reflected / p_reflect;
        } else {
            sample.direction = path.ray.direction;
            sample.weight = passed / (1 - p_reflect);
            sample.pdf_sr = path.pdf_sr;
            next.scattered_at = path.scattered_at;
            lift = -lift;
        }
    } else if (bsdf.is_glossy()) {
        sample = bsdf.sample_glossy(sampler.point(path.depth, Dimension::bsdf));
        albedo = max_component(bsdf.specular());
    } else if (bsdf.is_mirror()) {
        sample = bsdf.mirror();
        albedo = max_component(sample.weight);
    } else {
        return std::nullopt;
    }
    const double follow =
        settings_.roulette ? std::min(1.0, 4 * albedo * max_component(path.throughput)) : 1.0;
    if (choice.y >= follow || !(max_component(sample.weight) > 0)) return std::nullopt;
    next.ray = {surface.position + lift, sample.direction};
    next.throughput = path.throughput * sample.weight / follow;
    next.pdf_sr = sample.pdf_sr;
    return next;
}

}  // namespace

std::unique_ptr<Integrator> make_obscurance_integrator(const World& world, const RenderSettings& settings,
                                                       const Radiometry& radiometry, double d_max) {
    return std::make_unique<ObscuranceIntegrator>(world, settings, radiometry, d_max);
}

}  // namespace obscura::reference
