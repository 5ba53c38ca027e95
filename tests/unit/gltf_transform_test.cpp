// SPDX-License-Identifier: Apache-2.0
// Transforms without an inverse, or almost: meshes squeezed flat, to a needle or to a point, mirrored, sheared, and scaled
// up and down again; cameras and lights that lose their direction.
#include "scene/gltf.h"

#include "support/errors.h"
#include "support/gltf_load.h"
#include "support/gltf_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace obscura {
namespace {

using nlohmann::json;
using test::GltfBuilder;
using test::load;
using test::Loaded;
using test::sphere_below;
using test::SPHERE_TRIANGLES;

json scale(double x, double y, double z) {
    return {{"scale", {x, y, z}}};
}

// Images of the axes.
json matrix(const V3d& x, const V3d& y, const V3d& z) {
    return {{"matrix", {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1}}};
}

const json TURN = {
    {"rotation", {0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214}}};

Scene sphere(const std::vector<json>& chain) {
    Scene scene = load(sphere_below(chain)).scene;
    EXPECT_EQ(scene.triangles.size() + scene.dropped_triangles, SPHERE_TRIANGLES) << json(chain);
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_TRUE(std::isfinite(vertex.position.length()));
        // Unit length, or none where the sphere's edge is squeezed.
        const float length = vertex.normal.length();
        EXPECT_TRUE(std::abs(length - 1) < 1e-6f || length == 0) << vertex.normal;
    }
    return scene;
}

// Sum of the signed volumes of the tetrahedra below the triangles: positive when front sides look outwards.
double volume(const Scene& scene) {
    double sum = 0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        sum += V3d(scene.corner(i, 0).position)
                   .dot(V3d(scene.corner(i, 1).position).cross(V3d(scene.corner(i, 2).position))) /
               6;
    return sum;
}

const double WHOLE = volume(icosphere(test::SPHERE_LEVELS));

// Of any transform, the volume is the determinant's absolute value times the sphere's.
void expect_volume(const std::vector<json>& chain, double determinant) {
    const Scene scene = sphere(chain);
    EXPECT_EQ(scene.dropped_triangles, 0u) << json(chain);
    EXPECT_NEAR(volume(scene) / determinant, WHOLE, 1e-4) << json(chain);
    // So do vertex normals: of a point and its normal, transforms keep all but the length.
    for (const Vertex& vertex : scene.vertices)
        EXPECT_GT(V3d(vertex.position).dot(V3d(vertex.normal)), 0) << json(chain);
}

TEST(GltfTransform, HugeAndTinyFactorsCancel) {
    expect_volume({scale(1e20, 1e20, 1e20), scale(1e-20, 1e-20, 1e-20)}, 1);
    expect_volume({scale(1e38, 1e38, 1e38), TURN, scale(1e-38, 1e-38, 1e-38)}, 1);
    expect_volume({scale(1e-30, 1e25, 1e10), scale(1e30, 1e-25, 1e-10)}, 1);
    expect_volume({scale(1e-200, 1e-200, 1e-200), TURN, scale(1e200, 1e200, 1e200)}, 1);
}

TEST(GltfTransform, MirroringsTurnFrontsOutwardsAgain) {
    expect_volume({scale(-1, 1, 1)}, 1);
    expect_volume({scale(-1, -1, -1), TURN, scale(1, -1, 1), TURN, scale(-1, 1, 1)}, 1);
    expect_volume({scale(1e20, -1e20, 1e20), TURN, scale(1e-20, 1e-20, 1e-20)}, 1);
    expect_volume({matrix({0, 1, 0}, {1, 0, 0}, {0, 0, 1})}, 1);
}

TEST(GltfTransform, AlmostFlatMeshesKeepTheirSides) {
    for (const double thin : {1e-3, 1e-10, 1e-20, 1e-30}) {
        for (const double sign : {1, -1}) {
            expect_volume({scale(1, 1, sign * thin)}, thin);
            expect_volume({scale(1, sign * thin, 1)}, thin);
            expect_volume({scale(sign * thin, 1, 1), TURN}, thin);
            // Axes of which two are almost parallel.
            expect_volume({matrix({1, 0, 0}, {1, sign * thin, 0}, {0, 0, 1})}, thin);
        }
    }
}

TEST(GltfTransform, FlatMeshesLieInTheirPlane) {
    for (const auto& [squeeze, axis] : {std::pair{scale(1, 1, 0), 2},
                                        {scale(1, 0, 1), 1},
                                        {scale(0, -1, 1), 0},
                                        {matrix({1, 0, 0}, {1, 0, 0}, {0, 1, 1}), -1}}) {
        const Scene scene = sphere({squeeze});
        EXPECT_GT(scene.triangles.size(), SPHERE_TRIANGLES / 2) << squeeze;
        for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const V3d normal = geometric_normal(scene, i);
            const double upright = axis < 0 ? (normal.y - normal.z) * std::sqrt(0.5) : normal[axis];
            EXPECT_NEAR(std::abs(upright), 1, 1e-12) << squeeze;
            for (int k = 0; k < 3; ++k) {
                const V3d shading(scene.corner(i, k).normal);
                if (shading == V3d(0)) continue;
                EXPECT_NEAR(std::abs(shading.dot(normal)), 1, 1e-6) << squeeze;
            }
        }
        EXPECT_EQ(volume(scene), 0);
    }
}

TEST(GltfTransform, NeedlesAndPointsAreDroppedAndCounted) {
    for (const json& squeeze : {scale(1, 0, 0), scale(0, 0, 0), matrix({1, 1, 0}, {2, 2, 0}, {-1, -1, 0})}) {
        const Loaded loaded = load(sphere_below({squeeze, TURN}));
        EXPECT_TRUE(loaded.scene.triangles.empty()) << squeeze;
        EXPECT_EQ(loaded.scene.dropped_triangles, SPHERE_TRIANGLES) << squeeze;
        EXPECT_NE(loaded.said.find("320 triangles without area dropped"), std::string::npos) << loaded.said;
        EXPECT_EQ(loaded.scene.cameras.size(), 1u);
    }
}

std::string error_below(const json& squeeze, json node) {
    node["name"] = "poor thing";
    GltfBuilder file = sphere_below({json::object()});  // beside it
    file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}});
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}}, {{"type", "spot"}, {"spot", json::object()}}, {{"type", "directional"}}};
    json parent = squeeze;
    parent["children"] = {file.append("nodes", node)};
    file.append("nodes", parent);
    const test::TemporaryFolder folder;
    const std::string path = file.write_glb(folder.file("test.glb"));
    try {
        load_gltf(path);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

TEST(GltfTransform, CamerasAndLightsWithoutDirectionAreErrorsOfTheirNode) {
    const auto light = [](int index) {
        return json{{"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}};
    };
    const json camera = {{"camera", 0}};
    const auto expect_error = [](const std::string& error, const std::string& expected) {
        EXPECT_NE(error.find("test.glb: node 'poor thing': " + expected), std::string::npos) << error;
    };
    for (const json& squeeze : {scale(0, 0, 0), scale(1, 1, 0)}) {
        expect_error(error_below(squeeze, camera), "its transform leaves its camera no direction");
        expect_error(error_below(squeeze, light(1)), "its transform leaves its light no direction");
        expect_error(error_below(squeeze, light(2)), "its transform leaves its light no direction");
        EXPECT_EQ(error_below(squeeze, light(0)), "") << "a point light needs none";
    }
    // What a camera sees as up lies along its view, but for the rounding of the matrix.
    expect_error(error_below(matrix({1, 0, 0}, {0.1, 0.7, 0.2}, {0.3, 2.1, 0.6}), camera),
                 "its transform leaves its camera no direction");
    for (const json& squeeze : {scale(1e-20, 1e-20, 1e-20), scale(1, 1, 1e-20), scale(1e-20, 1, 1e20),
                                matrix({1, 0, 0}, {0, 1, 1}, {0, 1, 1.0001})})
        for (const json& node : {camera, light(0), light(1), light(2)})
            EXPECT_EQ(error_below(squeeze, node), "") << squeeze << node;
}

TEST(GltfTransform, OverflowIsAnErrorOfItsNode) {
    const json huge = {{"name", "huge"}, {"scale", {1e200, 1e200, 1e200}}};
    const test::TemporaryFolder folder;
    EXPECT_INPUT_ERROR(load_gltf(sphere_below({huge, huge}).write_glb(folder.file("test.glb"))),
                       "test.glb: node 'huge': its transform overflows");
}

}  // namespace
}  // namespace obscura
