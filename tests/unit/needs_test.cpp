// SPDX-License-Identifier: Apache-2.0
// What a scene needs modelled, feature by feature: off in a plain scene, on when one thing is added.
#include "scene/needs.h"

#include "support/scene_builder.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using test::matte;
using test::SceneBuilder;

Scene scene_of(const Material& material, bool smooth = false) {
    SceneBuilder builder;
    builder.sphere(V3f(0, 0, 0), 1, 1, builder.material(material), false, smooth);
    return builder.finish();
}

Scene with_light(LightType type, float intensity = 1) {
    Scene scene = scene_of(matte(Rgb(0.5f)));
    PunctualLight light;
    light.type = type;
    light.intensity = Rgb(intensity);
    scene.lights.push_back(light);
    return scene;
}

std::string reason_of(const std::string& name, const Scene& scene, const RenderSettings& settings = {}) {
    for (const Need& need : explain_needs(scene, settings))
        if (need.name == name) return need.reason;
    return "missing";
}

TEST(Needs, MatteSceneNeedsOnlyAmbientLight) {
    Needs expected;
    expected.ambient = expected.obscurance = expected.bleeding = true;
    EXPECT_EQ(analyse_needs(scene_of(matte(Rgb(0.5f))), {}), expected);
    EXPECT_FALSE(expected.direct());
}

TEST(Needs, EmissiveTrianglesNeedAreaLights) {
    const Scene scene = scene_of(matte(Rgb(0.5f), Rgb(1, 0, 0)));
    const Needs needs = analyse_needs(scene, {});
    EXPECT_TRUE(needs.area_lights && needs.emission && needs.direct());
    EXPECT_EQ(reason_of("area_lights", scene), "80 emissive triangles");
    RenderSettings settings;
    settings.direct = false;
    EXPECT_FALSE(analyse_needs(scene, settings).area_lights);
    EXPECT_TRUE(analyse_needs(scene, settings).emission);
    EXPECT_EQ(reason_of("area_lights", scene, settings), "--no-direct, and no rough specular lobe");
}

TEST(Needs, RoughLobeNeedsLightSamplesWithoutDirectLight) {
    Material glossy = test::metal(Rgb(0.9f), 0.3f);
    glossy.emission = Rgb(1);
    RenderSettings settings;
    settings.direct = false;
    EXPECT_TRUE(analyse_needs(scene_of(glossy), settings).area_lights);
    settings.specular = false;
    EXPECT_FALSE(analyse_needs(scene_of(glossy), settings).area_lights);
}

TEST(Needs, UnlitSurfaceIsSeenButNoLight) {
    Material picture = test::metal(Rgb(1), 0);
    picture.emission = Rgb(1);
    picture.transmission = 1;
    picture.unlit = true;
    const Needs needs = analyse_needs(scene_of(picture), {});
    EXPECT_TRUE(needs.emission);
    EXPECT_FALSE(needs.area_lights || needs.mirror || needs.transmission || needs.specular_paths);
}

TEST(Needs, LobesAreToldApart) {
    const Needs glossy = analyse_needs(scene_of(test::metal(Rgb(1), 0.5f)), {});
    EXPECT_TRUE(glossy.glossy && glossy.specular_paths);
    EXPECT_FALSE(glossy.mirror);
    const Needs mirror = analyse_needs(scene_of(test::metal(Rgb(1), 0.01f)), {});
    EXPECT_TRUE(mirror.mirror && mirror.specular_paths);
    EXPECT_FALSE(mirror.glossy);
}

TEST(Needs, RoughPaneHasAMirrorLobe) {
    Material pane = test::metal(Rgb(1), 0.5f);
    pane.transmission = 0.5f;
    const Needs needs = analyse_needs(scene_of(pane), {});
    EXPECT_TRUE(needs.transmission && needs.mirror);
    EXPECT_FALSE(needs.glossy);
}

TEST(Needs, SpecularSettingsSwitchPathsOff) {
    const Scene scene = scene_of(test::metal(Rgb(1), 0.5f));
    RenderSettings settings;
    settings.max_depth = 0;
    EXPECT_FALSE(analyse_needs(scene, settings).specular_paths);
    EXPECT_TRUE(analyse_needs(scene, settings).glossy);
    EXPECT_EQ(reason_of("specular_paths", scene, settings), "--max-depth 0");
    settings.specular = false;
    EXPECT_FALSE(analyse_needs(scene, settings).glossy);
    EXPECT_EQ(reason_of("glossy", scene, settings), "--no-specular");
}

TEST(Needs, PanesDimOtherRaysWithoutSpecularToo) {
    Material pane = matte(Rgb(1));
    pane.transmission = 0.9f;
    RenderSettings settings;
    EXPECT_TRUE(analyse_needs(scene_of(pane), settings).specular_paths);
    settings.specular = false;
    EXPECT_TRUE(analyse_needs(scene_of(pane), settings).transmission);
    EXPECT_FALSE(analyse_needs(scene_of(pane), settings).specular_paths);
}

TEST(Needs, EachPunctualLightHasItsFlag) {
    EXPECT_TRUE(analyse_needs(with_light(LightType::point), {}).point_lights);
    EXPECT_TRUE(analyse_needs(with_light(LightType::spot), {}).spot_lights);
    EXPECT_TRUE(analyse_needs(with_light(LightType::directional), {}).directional_lights);
    EXPECT_FALSE(analyse_needs(with_light(LightType::point), {}).spot_lights);
    EXPECT_FALSE(analyse_needs(with_light(LightType::point, 0), {}).direct());
    EXPECT_EQ(reason_of("point_lights", with_light(LightType::point)), "1 point light");
}

TEST(Needs, VertexNormalsCountOnlyWhereTheyDiffer) {
    EXPECT_TRUE(analyse_needs(scene_of(matte(Rgb(0.5f)), true), {}).smooth_normals);
    EXPECT_FALSE(analyse_needs(scene_of(matte(Rgb(0.5f)), false), {}).smooth_normals);
    SceneBuilder builder;
    builder.triangle(V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), builder.material(matte(Rgb(0.5f))));
    Scene flat = builder.finish();
    for (Vertex& vertex : flat.vertices)
        vertex.normal = V3f(0, 0, 1);
    EXPECT_FALSE(analyse_needs(flat, {}).smooth_normals);
    flat.vertices[1].normal = V3f(0.1f, 0, 1).normalized();
    EXPECT_TRUE(analyse_needs(flat, {}).smooth_normals);
    flat.vertices[2].normal = V3f(0, 0, 0);  // one is missing: shaded flat
    EXPECT_FALSE(analyse_needs(flat, {}).smooth_normals);
}

TEST(Needs, TexturesCountOnlyWhereUsed) {
    Material textured = matte(Rgb(0.5f));
    textured.base_color_texture = 0;
    Scene scene = scene_of(matte(Rgb(0.5f)));
    scene.textures.push_back(
        {"white", 1, 1, Wrap::repeat, Wrap::repeat, TextureFilter::linear, {255, 255, 255, 255}});
    scene.materials.push_back(textured);
    EXPECT_FALSE(analyse_needs(scene, {}).textures);
    scene.triangles[0].material = 1;
    EXPECT_TRUE(analyse_needs(scene, {}).textures);
    EXPECT_EQ(reason_of("textures", scene), "1 material has a base colour texture");
}

TEST(Needs, AmbientSettingsDecideOverRays) {
    const Scene scene = scene_of(matte(Rgb(0.5f)));
    RenderSettings settings;
    settings.bleeding = false;
    EXPECT_FALSE(analyse_needs(scene, settings).bleeding);
    EXPECT_TRUE(analyse_needs(scene, settings).obscurance);
    settings.ambient = Ambient::constant;
    EXPECT_FALSE(analyse_needs(scene, settings).obscurance);
    EXPECT_TRUE(analyse_needs(scene, settings).ambient);
    settings.ambient = Ambient::none;
    EXPECT_FALSE(analyse_needs(scene, settings).ambient);
    settings.ambient = Ambient::obscurance;
    settings.obscurance = false;
    EXPECT_FALSE(analyse_needs(scene, settings).ambient);
    EXPECT_EQ(reason_of("ambient", scene, settings), "--no-obscurance");
}

TEST(Needs, BlackSkyIsNoBackground) {
    const Scene scene = scene_of(matte(Rgb(0.5f)));
    RenderSettings settings;
    settings.background = Rgb(0, 0, 0);
    EXPECT_FALSE(analyse_needs(scene, settings).background);
    settings.background = Rgb(0, 0, 0.1f);
    EXPECT_TRUE(analyse_needs(scene, settings).background);
}

TEST(Needs, AllKeepsEverything) {
    RenderSettings settings;
    settings.needs = NeedsMode::all;
    settings.falloff = parse_falloff("sqrt");
    const Scene scene = scene_of(matte(Rgb(0.5f)));
    const std::vector<Need> rows = explain_needs(scene, settings);
    EXPECT_EQ(rows.size(), 15u);
    for (const Need& row : rows)
        EXPECT_TRUE(row.needed) << row.name;
    EXPECT_EQ(rows[0].reason, "no material has a base colour texture; kept by --needs all");
    const Needs needs = analyse_needs(scene, settings);
    EXPECT_TRUE(needs.textures && needs.background && needs.directional_lights && needs.specular_paths);
    EXPECT_EQ(needs.falloff, FalloffKind::sqrt);
}

TEST(Needs, RowsSayWhatTheFlagsSay) {
    Scene scene = scene_of(test::metal(Rgb(1), 0.5f), true);
    scene.materials[0].emission = Rgb(1);
    for (const bool specular : {true, false}) {
        RenderSettings settings;
        settings.specular = specular;
        const Needs needs = analyse_needs(scene, settings);
        const std::vector<bool> flags{needs.textures,     needs.smooth_normals, needs.glossy,
                                      needs.mirror,       needs.transmission,   needs.area_lights,
                                      needs.point_lights, needs.spot_lights,    needs.directional_lights,
                                      needs.emission,     needs.background,     needs.bleeding,
                                      needs.obscurance,   needs.ambient,        needs.specular_paths};
        const std::vector<Need> rows = explain_needs(scene, settings);
        ASSERT_EQ(rows.size(), flags.size());
        for (size_t i = 0; i < rows.size(); ++i) {
            EXPECT_EQ(rows[i].needed, flags[i]) << rows[i].name;
            EXPECT_FALSE(rows[i].reason.empty()) << rows[i].name;
        }
    }
}

}  // namespace
}  // namespace obscura
