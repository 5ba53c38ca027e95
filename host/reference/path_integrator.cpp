// SPDX-License-Identifier: Apache-2.0
// Path tracing of the same materials and lights without obscurances: each vertex samples the lights and one of its lobes,
// and what both can find is shared by the power heuristic, lobe by lobe. Paths end by roulette alone.
#include "reference/integrator.h"

#include <cmath>
#include <optional>

namespace obscura::reference {
namespace {

// Paths may end from this depth on, and go on at most with this probability, so that they end among white walls too.
constexpr uint32_t FIRST_ROULETTE_DEPTH = 3;
constexpr double MOST_SURVIVAL = 0.999;

struct PathState {
    Ray ray;
    RgbD throughput{1, 1, 1};
    uint32_t depth = 0;
    // Where the ray was scattered, and the density with which: lobe's choice times the lobe's pdf. Passing a pane leaves
    // both as they are, since shadow rays see through panes too. 0 = nothing else finds what this ray finds.
    V3d scattered_at{0, 0, 0};
    double pdf_sr = 0;
    uint32_t panes = 0;      // passed since
    bool diffuse = false;    // was scattered by a diffuse lobe
    bool reflected = false;  // by some diffuse lobe on its way

    uint32_t layer() const { return reflected ? LAYER_DIRECT : LAYER_EMISSION; }
};

// What light samples bring, by the lobe that reflects it.
struct ReflectedLight {
    RgbD diffuse{0, 0, 0}, glossy{0, 0, 0};
};

// Probabilities of the ways to go on.
struct LobeChoice {
    double diffuse = 0, specular = 0, pass = 0;
};

LobeChoice choose_lobes(const Bsdf& bsdf) {
    LobeChoice choice;
    choice.diffuse = mean_component(bsdf.diffuse());
    if (bsdf.is_pane()) {
        const auto [reflected, passed] = bsdf.pane();
        choice.specular = mean_component(reflected);
        choice.pass = mean_component(passed);
    } else {
        choice.specular = mean_component(bsdf.specular());
    }
    const double sum = choice.diffuse + choice.specular + choice.pass;
    if (!(sum > 0)) return {};
    return {choice.diffuse / sum, choice.specular / sum, choice.pass / sum};
}

class PathIntegrator : public Integrator {
  public:
    PathIntegrator(const World& world, const RenderSettings& settings)
        : world_(world), light_samples_(settings.light_samples), roulette_(settings.roulette) {}

    PathLight estimate(const Ray& camera_ray, const PathSampler& sampler) const override;

  private:
    RgbD emission(const PathState& path, const Surface& surface) const;
    ReflectedLight light_from_samples(const PathState& path, const Surface& surface, const Bsdf& bsdf,
                                      const LobeChoice& choice, const PathSampler& sampler,
                                      uint32_t& rays) const;
    void add_reflected_light(const Surface& surface, const Bsdf& bsdf, const LobeChoice& choice,
                             const LightSample& sample, ReflectedLight& light, uint32_t& rays) const;
    std::optional<PathState> continuation(const PathState& path, const Surface& surface, const Bsdf& bsdf,
                                          const LobeChoice& choice, const PathSampler& sampler) const;

    const World& world_;
    uint32_t light_samples_;
    bool roulette_;
};

PathLight PathIntegrator::estimate(const Ray& camera_ray, const PathSampler& sampler) const {
    PathLight light;
    std::optional<PathState> path = PathState{camera_ray};
    while (path) {
        ++light.rays;
        const Hit hit = world_.tracer.nearest(path->ray);
        if (!hit.found()) {
            light.parts[path->layer()] += path->throughput * world_.background;
            break;
        }
        if (path->depth == 0) light.coverage = 1;
        const Surface surface = world_.surfaces.surface_at(hit, path->ray.direction);
        if (surface.material->unlit) {
            // A picture that is seen, but lights nothing.
            if (!path->diffuse) light.parts[path->layer()] += path->throughput * surface.base;
            break;
        }
        light.parts[path->layer()] += path->throughput * emission(*path, surface);
        const Bsdf bsdf(surface, path->ray.direction);
        const LobeChoice choice = choose_lobes(bsdf);
        const auto [diffuse, glossy] = light_from_samples(*path, surface, bsdf, choice, sampler, light.rays);
        light.parts[LAYER_DIRECT] += path->throughput * diffuse;
        light.parts[path->layer()] += path->throughput * glossy;
        path = continuation(*path, surface, bsdf, choice, sampler);
    }
    return light;
}

RgbD PathIntegrator::emission(const PathState& path, const Surface& surface) const {
    if (path.pdf_sr == 0 || path.panes > MAX_PANES) return surface.emitted();
    const double distance = (surface.position - path.scattered_at).length();
    const double light_pdf =
        world_.lights.area_pdf_sr(surface.primitive, path.scattered_at, path.ray.direction, distance);
    return surface.emitted() * power_heuristic(path.pdf_sr, light_samples_ * light_pdf);
}

ReflectedLight PathIntegrator::light_from_samples(const PathState& path, const Surface& surface,
                                                  const Bsdf& bsdf, const LobeChoice& choice,
                                                  const PathSampler& sampler, uint32_t& rays) const {
    const SampleSet choices = sampler.light_points(path.depth, Dimension::select_light);
    const SampleSet points = sampler.light_points(path.depth, Dimension::area_light);
    ReflectedLight sum;
    for (uint32_t l = 0; l < light_samples_; ++l) {
        const V2d which = choices.exact(l);
        const V3d& position = surface.position;
        if (world_.lights.has_area_lights()) {
            add_reflected_light(surface, bsdf, choice,
                                world_.lights.sample_area(position, points[l], which.x), sum, rays);
        }
        if (world_.lights.has_punctual_lights()) {
            add_reflected_light(surface, bsdf, choice, world_.lights.sample_punctual(position, which.y), sum,
                                rays);
        }
    }
    return {sum.diffuse / light_samples_, sum.glossy / light_samples_};
}

void PathIntegrator::add_reflected_light(const Surface& surface, const Bsdf& bsdf, const LobeChoice& choice,
                                         const LightSample& sample, ReflectedLight& light,
                                         uint32_t& rays) const {
    const double cosine = sample.direction.dot(bsdf.n_shade());
    if (cosine <= 0 || sample.direction.dot(surface.n_geo) <= 0) return;
    if (!(max_component(sample.radiance) > 0)) return;
    const auto share = [&](double lobe_pdf_sr) {
        return sample.pdf_sr > 0 ? power_heuristic(light_samples_ * sample.pdf_sr, lobe_pdf_sr) : 1.0;
    };
    const RgbD diffuse =
        share(choice.diffuse * bsdf.diffuse_pdf_sr(sample.direction)) / std::numbers::pi * bsdf.diffuse();
    RgbD glossy(0);
    if (bsdf.is_glossy()) {
        const LobeValue lobe = bsdf.glossy(sample.direction);
        glossy = share(choice.specular * lobe.pdf_sr) * lobe.brdf;
    }
    if (!(max_component(diffuse + glossy) > 0)) return;
    ++rays;
    const RgbD arriving = cosine * sample.radiance * world_.transmittance(surface, sample);
    light.diffuse += diffuse * arriving;
    light.glossy += glossy * arriving;
}

std::optional<PathState> PathIntegrator::continuation(const PathState& path, const Surface& surface,
                                                      const Bsdf& bsdf, const LobeChoice& choice,
                                                      const PathSampler& sampler) const {
    const V2d u = sampler.point(path.depth, Dimension::lobe);
    const V2d direction_u = sampler.point(path.depth, Dimension::bsdf);
    PathState next = path;
    ++next.depth;
    LobeSample sample;
    double probability = 0;
    if (u.x < choice.pass) {
        probability = choice.pass;
        sample.direction = path.ray.direction;
        sample.weight = bsdf.pane().passed;
        next.ray.origin = surface.position - surface.lift;
        ++next.panes;
    } else {
        next.diffuse = u.x < choice.pass + choice.diffuse;
        next.reflected = path.reflected || next.diffuse;
        probability = next.diffuse ? choice.diffuse : choice.specular;
        sample = next.diffuse       ? bsdf.sample_diffuse(direction_u)
                 : bsdf.is_glossy() ? bsdf.sample_glossy(direction_u)
                                    : bsdf.mirror();
        if (bsdf.is_pane() && !next.diffuse) sample.weight = bsdf.pane().reflected;
        next.ray.origin = surface.position + surface.lift;
        next.scattered_at = surface.position;
        next.pdf_sr = probability * sample.pdf_sr;
        next.panes = 0;
    }
    if (!(max_component(sample.weight) > 0)) return std::nullopt;
    next.ray.direction = sample.direction;
    next.throughput *= sample.weight / probability;
    if (!roulette_ || next.depth < FIRST_ROULETTE_DEPTH) return next;
    const double survival = std::min(MOST_SURVIVAL, max_component(next.throughput));
    if (u.y >= survival) return std::nullopt;
    next.throughput /= survival;
    return next;
}

}  // namespace

std::unique_ptr<Integrator> make_path_integrator(const World& world, const RenderSettings& settings) {
    return std::make_unique<PathIntegrator>(world, settings);
}

}  // namespace obscura::reference
