// SPDX-License-Identifier: Apache-2.0
#include "cli/render_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/choice_option.h"
#include "cli/validators.h"
#include "sampling/lattice.h"

namespace obscura {
namespace {

constexpr uint32_t MAX_IMAGE_SIZE = 65536;  // pixels per side
constexpr const char* WORK_GROUP = "Work";
constexpr uint32_t MAX_SAMPLES = 1u << 24;  // per pixel and per point: float counts them exactly

CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
    return add_choice<bool>(command, name, value, {{"on", true}, {"off", false}}, help);
}

CLI::Option* add_rgb(CLI::App& command, const std::string& name, std::optional<Rgb>& value,
                     const std::string& help) {
    return command
        .add_option_function<std::vector<float>>(
            name,
            [&value, name](const std::vector<float>& rgb) {
                for (const float channel : rgb) {
                    if (!std::isfinite(channel) || channel < 0) {
                        throw CLI::ValidationError(name, "the three values must be finite and not negative");
                    }
                }
                value = Rgb(rgb[0], rgb[1], rgb[2]);
            },
            help)
        ->delimiter(',')
        ->expected(3)
        ->type_name("R,G,B");
}

void add_image_options(CLI::App& command, RenderOptions& o) {
    RenderSettings& s = o.settings;
    command.add_option("--width", s.width, "Pixels across")
        ->check(whole_number(1, MAX_IMAGE_SIZE))
        ->capture_default_str()
        ->group("Picture");
    command.add_option("--height", s.height, "Pixels down")
        ->check(whole_number(1, MAX_IMAGE_SIZE))
        ->capture_default_str()
        ->group("Picture");
    command.add_option("--spp,--samples-per-pixel", s.spp, "Camera rays per pixel")
        ->check(whole_number(1, MAX_SAMPLES))
        ->capture_default_str()
        ->group("Picture");
    command.add_option("--camera", s.camera, "Name or number of the scene's camera; the first if not given")
        ->check(not_empty())
        ->group("Picture");
    command
        .add_option_function<std::vector<double>>(
            "--cropwindow",
            [&s](const std::vector<double>& v) {
                const bool ordered =
                    0 <= v[0] && v[0] < v[1] && v[1] <= 1 && 0 <= v[2] && v[2] < v[3] && v[3] <= 1;
                if (!ordered)
                    throw CLI::ValidationError("--cropwindow",
                                               "needs 0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1");
                s.crop = {v[0], v[1], v[2], v[3]};
            },
            "Part of the picture to render, as fractions of its size")
        ->delimiter(',')
        ->expected(4)
        ->type_name("X0,X1,Y0,Y1")
        ->group("Picture");
    add_choice<PixelFilter>(command, "--filter", s.filter,
                            {{"box", PixelFilter::box},
                             {"tent", PixelFilter::tent},
                             {"gauss", PixelFilter::gauss},
                             {"bh", PixelFilter::blackman_harris}},
                            "Pixel filter")
        ->default_str("box")
        ->group("Picture");
    add_rgb(command, "--background", s.background, "Radiance of the sky behind the scene")->group("Picture");
}

void add_model_options(CLI::App& command, RenderOptions& o) {
    RenderSettings& s = o.settings;
    const char* group = "Obscurances and light";
    command
        .add_option("--obscurance-rays,--ao-samples", s.obscurance_rays,
                    "Obscurance rays per diffuse hit (K)")
        ->check(whole_number(1, MAX_SAMPLES))
        ->capture_default_str()
        ->group(group);
    command.add_option("--rho,--falloff", o.rho, "Falloff: step|linear|sqrt|cbrt|exp[:lambda]|expjump|pow:p")
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--dmax,--ao-distance", o.d_max,
                    "Reach of the obscurances: metres, per cent of the scene's diagonal (50%), or inf")
        ->capture_default_str()
        ->group(group);
    CLI::Option* const ambient =
        add_choice<Ambient>(
            command, "--ambient", s.ambient,
            {{"obscurance", Ambient::obscurance}, {"constant", Ambient::constant}, {"none", Ambient::none}},
            "Ambient light: weighted by obscurances, constant, or none")
            ->default_str("obscurance")
            ->group(group);
    add_switch(command, "--bleeding", s.bleeding,
               "Colour bleeding: obscurance rays carry the colour they meet")
        ->default_str("on")
        ->group(group);
    CLI::Option* const light = add_rgb(command, "--ambient-light", s.ambient_light,
                                       "Ambient radiance at an open point, instead of the scene's")
                                   ->group(group);
    CLI::Option* const scale =
        command.add_option("--ambient-scale", s.ambient_scale, "Multiplies the ambient light")
            ->check(number_between(0, 1e6))
            ->capture_default_str()
            ->group(group);
    command
        .add_flag_callback(
            "--no-obscurance", [&s] { s.obscurance = false; }, "Leave out the ambient light")
        ->excludes(ambient)
        ->excludes(light)
        ->excludes(scale)
        ->group(group);
    command
        .add_flag_callback(
            "--no-direct", [&s] { s.direct = false; }, "Leave out direct light on diffuse surfaces")
        ->group(group);
    command
        .add_flag_callback(
            "--no-specular", [&s] { s.specular = false; }, "Leave out reflections and transmission")
        ->group(group);
    command.add_option("--light-samples", s.light_samples, "Shadow rays per hit for each group of lights")
        ->check(whole_number(1, 4096))
        ->capture_default_str()
        ->group(group);
    command.add_option("--max-depth", s.max_depth, "Longest chain of reflections")
        ->check(whole_number(0, 64))
        ->capture_default_str()
        ->group(group);
    add_switch(command, "--roulette", s.roulette,
               "Follow weak reflections only now and then, with more weight")
        ->default_str("on")
        ->group(group);
}

void add_sample_options(CLI::App& command, RenderOptions& o) {
    RenderSettings& s = o.settings;
    add_choice<SamplerKind>(
        command, "--sampler", s.sampler,
        {{"lattice", SamplerKind::lattice}, {"owen", SamplerKind::owen}, {"random", SamplerKind::random}},
        "Sample points")
        ->default_str("lattice")
        ->group(WORK_GROUP);
    command.add_option("--seed", s.seed, "Another seed, another noise")
        ->check(whole_number())
        ->capture_default_str()
        ->group(WORK_GROUP);
    command.add_flag("--quiet", o.quiet, "Print only warnings and errors")->group(WORK_GROUP);
}

void add_device_options(CLI::App& command, RenderOptions& o) {
    command
        .add_option(
            "--device", o.device,
            "Index, platform:device, or part of the device's or platform's name or version (see "
            "obscura devices); the variable OBSCURA_DEVICE if not given. render shares its work among "
            "several, A,B, and splits one into N by A/N")
        ->check(not_empty())
        ->group(WORK_GROUP);
    command.add_option("--memory", o.memory, "Each device's memory for the queues: bytes, or with K, M, G")
        ->capture_default_str()
        ->group(WORK_GROUP);
    command
        .add_option("--wave-size", o.wave_size,
                    "Camera samples in flight at once; changes speed, not pictures")
        ->check(whole_number(1, uint64_t{1} << 31))
        ->capture_default_str()
        ->group(WORK_GROUP);
    command
        .add_option("--local-size", o.local_size, "Work items per work group; changes speed, not pictures")
        ->check(whole_number(1, 4096))
        ->capture_default_str()
        ->group(WORK_GROUP);
    add_choice<NeedsMode>(command, "--needs", o.settings.needs,
                          {{"auto", NeedsMode::automatic}, {"all", NeedsMode::all}},
                          "Model only what the scene needs, or everything")
        ->default_str("auto")
        ->group(WORK_GROUP);
    command
        .add_flag("--portable-kernels", o.portable,
                  "One ray per work item, no instruction of one processor; the same pictures, slower on CPUs")
        ->group(WORK_GROUP);
}

void check_ambient_options(const RenderSettings& settings) {
    if (settings.ambient != Ambient::none) return;
    if (settings.ambient_light) throw InputError("--ambient none leaves nothing to --ambient-light");
    if (settings.ambient_scale != 1) throw InputError("--ambient none leaves nothing to --ambient-scale");
}

// A pixel's points of one kind are numbered through: spp times those of each camera ray.
void check_set_size(uint32_t spp, const char* option, uint32_t count) {
    if (uint64_t{spp} * count <= MAX_SET_POINTS) return;
    throw InputError(
        "--spp {} times {} {} are more than {} points per pixel, which the samplers can't number", spp,
        option, count, MAX_SET_POINTS);
}

}  // namespace

std::shared_ptr<RenderOptions> add_host_options(CLI::App& command) {
    auto options = std::make_shared<RenderOptions>();
    command
        .add_option("scene", options->scene,
                    "glTF file (.gltf, .glb), or a folder that holds one of its name")
        ->required()
        ->type_name("SCENE");
    add_image_options(command, *options);
    add_model_options(command, *options);
    add_sample_options(command, *options);
    return options;
}

std::shared_ptr<RenderOptions> add_render_options(CLI::App& command) {
    auto options = add_host_options(command);
    add_device_options(command, *options);
    return options;
}

RenderSettings settings_of(const RenderOptions& options) {
    RenderSettings settings = options.settings;
    check_set_size(settings.spp, "--obscurance-rays", settings.obscurance_rays);
    check_set_size(settings.spp, "--light-samples", settings.light_samples);
    check_ambient_options(settings);
    settings.falloff = parse_falloff(options.rho);
    settings.d_max = parse_max_distance(options.d_max);
    return settings;
}

uint64_t parse_bytes(const std::string& text) {
    static const std::map<char, double> units{{'K', 1024.0}, {'M', 1048576.0}, {'G', 1073741824.0}};
    std::string number = text;
    double unit = 1;
    if (!number.empty() && (number.back() == 'B' || number.back() == 'b')) number.pop_back();
    if (number.size() > 1 && (number.back() == 'i')) number.pop_back();
    if (!number.empty()) {
        const auto found =
            units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(number.back()))));
        if (found != units.end()) {
            unit = found->second;
            number.pop_back();
        }
    }
    double value = 0;
    size_t used = 0;
    try {
        value = std::stod(number, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    const double bytes = value * unit;
    if (used == 0 || used != number.size() || !(bytes >= 1) || bytes > 1e15) {
        throw InputError("--memory {}: give bytes, or a number with K, M or G, such as 256M", text);
    }
    return static_cast<uint64_t>(bytes);
}

}  // namespace obscura
