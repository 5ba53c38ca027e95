// SPDX-License-Identifier: Apache-2.0
#include "reference/sweep_methods.h"

#include "base/error.h"
#include "reference/accumulator.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace obscura {
namespace {

using reference::IntegratorKind;

class MethodList {
  public:
    explicit MethodList(const RenderSettings& base) : base_(base) {
        base_.obscurance_rays = PAPER_OBSCURANCE_RAYS;
    }

    // Measured against its own model. change: of the settings in common.
    template <typename Change>
    SweepMethod& add_sampling(const std::string& name, const std::string& meaning, const Change& change) {
        return add({name, meaning, IntegratorKind::obscurance, base_}, change);
    }
    // Measured against all light.
    template <typename Change>
    void add_model(const std::string& name, const std::string& meaning, const Change& change) {
        add({name, meaning, IntegratorKind::path, base_}, change);
    }
    void add_path_tracing() {
        methods_.push_back(
            {"path", "path tracing on the host, double precision", IntegratorKind::path, base_, true});
    }

    std::vector<SweepMethod> take() { return std::move(methods_); }

  private:
    template <typename Change>
    SweepMethod& add(SweepMethod method, const Change& change) {
        change(method.settings);
        return methods_.emplace_back(std::move(method));
    }

    RenderSettings base_;
    std::vector<SweepMethod> methods_;
};

void add_samplers(MethodList& list) {
    const auto sampler = [](SamplerKind kind) {
        return [kind](RenderSettings& settings) { settings.sampler = kind; };
    };
    list.add_sampling("lattice", "rank-1 lattice, 5 obscurance rays per sample",
                      sampler(SamplerKind::lattice));
    list.add_sampling("owen", "scrambled Sobol points, 5 rays per sample", sampler(SamplerKind::owen));
    list.add_sampling("random", "random points, 5 rays per sample", sampler(SamplerKind::random));
}

void add_splits(MethodList& list) {
    for (const uint32_t rays : {10u, 2u, 1u}) {
        list.add_sampling(fmt::format("k{}", rays),
                          fmt::format("lattice, {} obscurance ray{} per sample", rays, rays == 1 ? "" : "s"),
                          [rays](RenderSettings& settings) { settings.obscurance_rays = rays; });
    }
}

// The same pictures from kernels that were compiled otherwise.
void add_builds(MethodList& list) {
    list.add_sampling("needs-all", "lattice with every feature compiled in",
                      [](RenderSettings& settings) { settings.needs = NeedsMode::all; });
    list.add_sampling("portable", "lattice with kernels that use no instructions of one processor",
                      [](RenderSettings&) {})
        .portable = true;
}

void add_models(MethodList& list, const RenderSettings& base) {
    list.add_model("none", "no ambient light", [](RenderSettings& s) { s.ambient = Ambient::none; });
    list.add_model("constant", "constant ambient light",
                   [](RenderSettings& s) { s.ambient = Ambient::constant; });
    list.add_model("ao", "ambient occlusion: the step, no bleeding", [](RenderSettings& s) {
        s.falloff = {FalloffKind::step};
        s.bleeding = false;
    });
    list.add_model("colourless", "obscurances without bleeding",
                   [](RenderSettings& s) { s.bleeding = false; });
    list.add_model("obscurance", "obscurances with bleeding", [](RenderSettings&) {});
    for (const char* rho : {"step", "linear", "sqrt", "exp"}) {
        if (falloff_text(base.falloff) == rho) continue;  // it is "obscurance"
        list.add_model(fmt::format("rho-{}", rho), fmt::format("obscurances with bleeding, rho {}", rho),
                       [rho](RenderSettings& s) { s.falloff = parse_falloff(rho); });
    }
    if (base.d_max.unit == MaxDistance::Unit::infinite) return;
    for (const double factor : {0.25, 0.5, 2.0, 4.0}) {
        list.add_model(fmt::format("dmax-x{}", factor),
                       fmt::format("obscurances with bleeding, {} times as far", factor),
                       [factor](RenderSettings& s) { s.d_max.value *= factor; });
    }
}

}  // namespace

uint32_t SweepMethod::rays_per_sample() const {
    const bool traces_obscurances = !path_traced && settings.ambient == Ambient::obscurance;
    return traces_obscurances ? settings.obscurance_rays : PAPER_OBSCURANCE_RAYS;
}

std::vector<uint32_t> SweepMethod::budgets(uint32_t count) const {
    std::vector<uint32_t> budgets;
    for (uint32_t budget = PAPER_OBSCURANCE_RAYS; budgets.size() < count; budget *= 2)
        if (budget % rays_per_sample() == 0) budgets.push_back(budget);
    return budgets;
}

std::vector<std::string> SweepMethod::layers() const {
    if (reference == IntegratorKind::path) return {"", reference::DIFFUSE_LAYER};
    return {"", reference::DIFFUSE_LAYER, "obscurance"};
}

std::vector<SweepMethod> sweep_methods(const RenderSettings& base) {
    MethodList list(base);
    add_samplers(list);
    add_splits(list);
    add_builds(list);
    add_models(list, base);
    list.add_path_tracing();
    return list.take();
}

std::vector<SweepMethod> choose_methods(const std::vector<SweepMethod>& methods,
                                        std::span<const std::string> names) {
    std::vector<std::string> known;
    known.reserve(methods.size());
    for (const SweepMethod& method : methods)
        known.push_back(method.name);
    for (const std::string& name : names) {
        if (std::ranges::find(known, name) == known.end())
            throw InputError("--methods {}: there is no such method; choose from {}", name,
                             fmt::join(known, ", "));
    }
    std::vector<SweepMethod> chosen;
    for (const SweepMethod& method : methods)
        if (names.empty() || std::ranges::find(names, method.name) != names.end()) chosen.push_back(method);
    return chosen;
}

}  // namespace obscura
