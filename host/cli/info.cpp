// SPDX-License-Identifier: Apache-2.0
// See info.h.
#include "cli/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "base/units.h"
#include "cli/json_output.h"
#include "scene/gltf.h"
#include "scene/local_frame.h"
#include "scene/material.h"
#include "scene/needs.h"
#include "scene/radiometry.h"

namespace obscura {

namespace {

constexpr size_t MOST_LIGHTS = 10;  // in the table; the JSON has all

// Everything that is shown, computed once for table and JSON.
struct SceneInfo {
    std::string file;
    Scene scene;
    Radiometry radiometry;
    std::vector<Need> needs;
    uint32_t emissive_triangles = 0;
};

SceneInfo gather_info(const std::string& path) {
    SceneInfo info;
    info.file = find_scene_file(path).string();
    info.scene = load_gltf(info.file);
    info.radiometry = compute_radiometry(info.scene);
    const Scene& scene = info.scene;
    info.needs = explain_needs(scene, with_default_sky(scene, {}));
    for (const Triangle& triangle : scene.triangles) {
        if (is_emissive(scene.materials[triangle.material])) ++info.emissive_triangles;
    }
    return info;
}

const char* type_name(LightType type) {
    switch (type) {
        case LightType::point:
            return "point";
        case LightType::spot:
            return "spot";
        case LightType::directional:
            return "directional";
    }
    return "unknown";
}

template <typename Vector>
Json to_json(const Vector& v) {
    return {v.x, v.y, v.z};
}

Json cameras_json(const Scene& scene) {
    Json rows = Json::array();
    for (const Camera& local : scene.cameras) {
        const Camera camera = world_camera(scene, local);
        Json row = {{"name", camera.name},
                    {"orthographic", camera.orthographic},
                    {"position", to_json(camera.camera_to_world.translation())}};
        if (camera.orthographic)
            row["half_height"] = camera.half_height;
        else
            row["vertical_fov"] = camera.vertical_fov;
        rows.push_back(row);
    }
    return rows;
}

Json lights_json(const Scene& scene) {
    Json rows = Json::array();
    for (const PunctualLight& light : scene.lights) {
        Json row = {{"name", light.name},
                    {"type", type_name(light.type)},
                    {"intensity", to_json(world_intensity(scene, light))}};
        if (light.type != LightType::directional)
            row["position"] = to_json(world_position(scene, light.position));
        rows.push_back(row);
    }
    return rows;
}

Json to_json(const SceneInfo& info) {
    const Scene& scene = info.scene;
    Json result = {{"file", info.file},
                   {"triangles", scene.triangles.size()},
                   {"dropped_triangles", scene.dropped_triangles},
                   {"vertices", scene.vertices.size()},
                   {"objects", scene.objects.size()},
                   {"materials", scene.materials.size()},
                   {"textures", scene.textures.size()},
                   {"emissive_triangles", info.emissive_triangles},
                   {"lights", lights_json(scene)},
                   {"cameras", cameras_json(scene)},
                   {"area", info.radiometry.area},
                   {"diagonal", diagonal(scene)},
                   {"emitted", to_json(info.radiometry.emitted)},
                   {"R_ave", to_json(info.radiometry.average_reflectivity)},
                   {"I_A", to_json(info.radiometry.ambient_bleeding)},
                   {"I_A_colourless", to_json(info.radiometry.ambient_colourless)},
                   {"needs", Json::array()},
                   {"needs_reasons", Json::object()}};
    if (!scene.bounds.isEmpty())
        result["bounds"] = {{"min", to_json(world_position(scene, scene.bounds.min))},
                            {"max", to_json(world_position(scene, scene.bounds.max))}};
    for (const Need& need : info.needs) {
        if (need.needed) result["needs"].push_back(need.name);
        result["needs_reasons"][need.name] = need.reason;
    }
    return result;
}

template <typename... Args>
void print_row(const std::string& label, fmt::format_string<Args...> format, Args&&... args) {
    fmt::print("  {:<16}{}\n", label, fmt::format(format, std::forward<Args>(args)...));
}

std::string rgb_text(const RgbD& color) {
    return fmt::format("{:<10.5g} {:<10.5g} {:<10.5g}", color.x, color.y, color.z);
}

void print_geometry(const SceneInfo& info) {
    const Scene& scene = info.scene;
    fmt::print("{}\n\nGeometry\n", info.file);
    print_row("triangles", "{}", scene.triangles.size());
    if (scene.dropped_triangles > 0)
        print_row("dropped", "{} without area", counted(scene.dropped_triangles, "triangle"));
    print_row("vertices", "{}", scene.vertices.size());
    print_row("objects", "{}", scene.objects.size());
    print_row("materials", "{}", scene.materials.size());
    print_row("textures", "{}", scene.textures.size());
    if (scene.bounds.isEmpty()) return;
    for (int axis = 0; axis < 3; ++axis)
        print_row(fmt::format("extent in {}", "xyz"[axis]), "{:.5g} to {:.5g} m",
                  world_position(scene, scene.bounds.min)[axis],
                  world_position(scene, scene.bounds.max)[axis]);
    print_row("diagonal", "{:.5g} m", diagonal(scene));
}

void print_lights(const SceneInfo& info) {
    fmt::print("\nLights\n");
    print_row("area lights", "{}", counted(info.emissive_triangles, "emissive triangle"));
    const auto& lights = info.scene.lights;
    for (size_t i = 0; i < std::min(lights.size(), MOST_LIGHTS); ++i) {
        const bool directional = lights[i].type == LightType::directional;
        const RgbD intensity = world_intensity(info.scene, lights[i]);
        const V3d at = world_position(info.scene, lights[i].position);
        print_row(type_name(lights[i].type), "{}{:.5g} {:.5g} {:.5g} {} (RGB){}",
                  lights[i].name.empty() ? "" : lights[i].name + ": ", intensity.x, intensity.y, intensity.z,
                  directional ? "W/m^2" : "W/sr",
                  directional ? "" : fmt::format(" at ({:.4g}, {:.4g}, {:.4g})", at.x, at.y, at.z));
    }
    if (lights.size() > MOST_LIGHTS) print_row("and", "{} more", lights.size() - MOST_LIGHTS);
}

void print_cameras(const SceneInfo& info) {
    fmt::print("\nCameras\n");
    for (size_t i = 0; i < info.scene.cameras.size(); ++i) {
        const Camera camera = world_camera(info.scene, info.scene.cameras[i]);
        const V3d position = camera.camera_to_world.translation();
        const std::string lens =
            camera.orthographic
                ? fmt::format("orthographic, {:.4g} m high", 2 * camera.half_height)
                : fmt::format("{:.4g} degrees high", camera.vertical_fov * 180 / std::numbers::pi);
        print_row(std::to_string(i), "{} at ({:.4g}, {:.4g}, {:.4g}), {}",
                  camera.name.empty() ? "unnamed" : camera.name, position.x, position.y, position.z, lens);
    }
}

void print_averages(const SceneInfo& info) {
    const Radiometry& radiometry = info.radiometry;
    fmt::print("\nAverages             red        green      blue\n");
    print_row("area A_T", "{:<10.5g} m^2, both sides of double-sided surfaces", radiometry.area);
    print_row("R_ave", "{} average reflectivity", rgb_text(radiometry.average_reflectivity));
    print_row("I_A", "{} W/(sr m^2), ambient light with colour bleeding",
              rgb_text(radiometry.ambient_bleeding));
    print_row("I_A colourless", "{} W/(sr m^2), with --bleeding off",
              rgb_text(radiometry.ambient_colourless));
}

void print_needs(const SceneInfo& info) {
    fmt::print("\nNeeds (features the kernels are built with, at default settings)\n");
    for (const Need& need : info.needs)
        fmt::print("  {:<3} {:<20}{}\n", need.needed ? "yes" : "-", need.name, need.reason);
}

}  // namespace

void add_info_command(CLI::App& app, ExitCode& exit_code) {
    CLI::App* const command =
        app.add_subcommand("info", "Show what a scene holds, its averages, and which features it needs");
    const auto scene = std::make_shared<std::string>();
    const auto json_target = std::make_shared<std::string>();
    command->add_option("scene", *scene, "glTF file (.gltf, .glb), or a folder that holds one of its name")
        ->required()
        ->type_name("SCENE");
    command->add_option("--json", *json_target, "Write the same as JSON to FILE; - is standard output")
        ->type_name("FILE|-");
    command->callback([scene, json_target, &exit_code] {
        const SceneInfo info = gather_info(*scene);
        if (json_target->empty()) {
            print_geometry(info);
            print_lights(info);
            print_cameras(info);
            print_averages(info);
            print_needs(info);
        } else {
            write_json(*json_target, to_json(info));
        }
        exit_code = ExitCode::ok;
    });
}

}  // namespace obscura
