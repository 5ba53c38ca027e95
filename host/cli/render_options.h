// SPDX-License-Identifier: Apache-2.0
// The options shared by every subcommand that traces, and how they become settings.
#pragma once

#include <CLI/App.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/settings.h"
#include "wavefront/render.h"

namespace obscura {

// What the command line says, as text where the text needs checking of its own.
struct RenderOptions {
    std::string scene;
    RenderSettings settings;
    std::string rho = "exp";
    std::string d_max = "1";
    std::string device;
    std::string memory = std::to_string(DEFAULT_QUEUE_BYTES >> 20) + "M";
    uint64_t wave_size = DEFAULT_WAVE_SIZE;
    uint32_t local_size = 64;
    bool portable = false;
    bool quiet = false;
};

// Registers the positional SCENE and the shared options on a subcommand, but for those of an OpenCL device.
std::shared_ptr<RenderOptions> add_host_options(CLI::App& command);
// All of them.
std::shared_ptr<RenderOptions> add_render_options(CLI::App& command);

// Converts what CLI11 left as text, falloff and d_max, and checks what only several options together tell. Throws
// InputError.
RenderSettings settings_of(const RenderOptions& options);

// "256M", "1.5G", "1073741824", with K, M, G as powers of 1024. Throws InputError.
uint64_t parse_bytes(const std::string& text);

}  // namespace obscura
