// SPDX-License-Identifier: Apache-2.0
// What the kernels make of a hit: normals and offsets of slivers, and textures far outside their unit square.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "device/scene_buffers.h"
#include "reference/meshes.h"
#include "reference/ray_capture.h"
#include "support/device.h"

namespace obscura {
namespace {

constexpr float FAR = std::numeric_limits<float>::infinity();

struct Corners {
    V3f a, b, c;
};

Scene lone_triangle(const Corners& corners) {
    MeshBuilder mesh;
    mesh.triangle(corners.a, corners.b, corners.c);
    return mesh.finish();
}

// Where the kernels put the hits of rays, and how far they lift what leaves from there.
struct Point {
    V3f position, normal;
    float offset;
};

class SurfaceProbe {
  public:
    explicit SurfaceProbe(Device& device) : device_(device), library_(device) {
        constexpr const char* SOURCE = R"(
#include "lib/surface.clh"
kernel void probe(global const SceneTriangle* triangle, global const float4* hits, global float4* out, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    const Surface s = make_surface(triangle, hits[2u * i].y, hits[2u * i].z, hits[2u * i + 1u].xyz);
    out[2u * i] = (float4)(s.position, s.offset);
    out[2u * i + 1u] = (float4)(s.n_geo, 0.0f);
})";
        kernel_ = library_.kernel_from_text("surface probe", SOURCE, "probe");
    }

    std::vector<Point> points(const Corners& corners, const std::vector<TraceRay>& rays,
                              const std::vector<TraceHit>& hits) {
        std::vector<f32x4> lanes;
        for (size_t i = 0; i < rays.size(); ++i) {
            const V3f& direction = rays[i].direction;
            lanes.push_back({hits[i].t, hits[i].u, hits[i].v, 0});
            lanes.push_back({direction.x, direction.y, direction.z, 0});
        }
        const SceneArrays arrays = make_scene_arrays(lone_triangle(corners), PixelFilter::box);
        const Buffer triangle_buffer = Buffer::holding(device_, "triangle", "test", arrays.triangles);
        const Buffer in = Buffer::holding(device_, "hits", "test", lanes);
        const Buffer out(device_, "surfaces", "test", lanes.size() * sizeof(f32x4));
        launch(device_, kernel_, "surface probe", rays.size(), library_.local_size(), triangle_buffer, in,
               out, static_cast<uint32_t>(rays.size()));
        const std::vector<f32x4> found = out.contents<f32x4>();
        std::vector<Point> points;
        for (size_t i = 0; i < found.size(); i += 2)
            points.push_back({{found[i].x, found[i].y, found[i].z},
                              {found[i + 1].x, found[i + 1].y, found[i + 1].z},
                              found[i].w});
        return points;
    }

  private:
    Device& device_;
    ProgramLibrary library_;
    cl::Kernel kernel_;
};

// Triangles of one metre and of many shapes, turned and moved; the last one's plain float cross product is zero.
std::vector<Corners> shapes() {
    std::vector<Corners> all;
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto any = [&] { return V3d(normal(random), normal(random), normal(random)); };
    for (const double height : {1.0, 1e-2, 1e-4, 1e-6, 1e-7}) {
        for (const double foot : {0.0, 0.4}) {
            for (const double distance : {0.0, 10.0, 1000.0}) {
                const V3d x = any().normalized();
                const V3d y = x.cross(any()).normalized();
                const V3d at = distance * any().normalized();
                const Corners corners{V3f(at), V3f(at + x), V3f(at + foot * x + height * y)};
                if (edge_product(corners.a, corners.b, corners.c) > 0) all.push_back(corners);
            }
        }
    }
    all.push_back({{0, 0, 0}, {0.5118216f, 0.9504637f, 0}, {0.22135203f, 0.41105545f, 0}});
    return all;
}

class SurfaceStage : public test::DeviceTest {
  protected:
    // Rays from all around to points of the triangle: those that hit it, with their hits.
    static void hit_everywhere(DeviceTracer& tracer, const Corners& t, std::vector<TraceRay>& rays,
                               std::vector<TraceHit>& hits) {
        std::mt19937 random(2);
        std::uniform_real_distribution<double> unit;
        std::normal_distribution<double> normal;
        std::vector<TraceRay> all;
        for (int i = 0; i < 20000; ++i) {
            double u = unit(random), v = unit(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const V3d target = (1 - u - v) * V3d(t.a) + u * V3d(t.b) + v * V3d(t.c);
            const V3f origin(target + V3d(normal(random), normal(random), normal(random)));
            all.push_back({origin, V3f((target - V3d(origin)).normalized()), FAR});
        }
        const std::vector<TraceHit> found = tracer.closest(all);
        for (size_t i = 0; i < all.size(); ++i) {
            if (found[i].primitive == NO_PRIMITIVE) continue;
            rays.push_back(all[i]);
            hits.push_back(found[i]);
        }
    }
};

TEST_F(SurfaceStage, RaysThatLeaveATriangleDoNotHitItAgain) {
    SurfaceProbe probe(device());
    ProgramLibrary library(device());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit;
    size_t shape = 0;
    for (const Corners& corners : shapes()) {
        SCOPED_TRACE("shape " + std::to_string(shape++));
        DeviceTracer tracer(device(), library, build_bvh(lone_triangle(corners)));
        std::vector<TraceRay> rays;
        std::vector<TraceHit> hits;
        hit_everywhere(tracer, corners, rays, hits);
        ASSERT_GT(hits.size(), 2000u);
        std::vector<TraceRay> leaving;
        for (const Point& point : probe.points(corners, rays, hits)) {
            ASSERT_NEAR(point.normal.length(), 1, 1e-6f);
            ASSERT_TRUE(std::isfinite(point.offset));
            // Towards the normal's side, many of them at grazing angles.
            const V3d n(point.normal);
            const V3d x = n.cross(std::abs(n.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
            const double cosine = std::pow(unit(random), 3);
            const double phi = 2 * std::numbers::pi * unit(random);
            const V3d side = std::cos(phi) * x + std::sin(phi) * n.cross(x);
            const V3f direction(cosine * n + std::sqrt(1 - cosine * cosine) * side);
            if (direction.dot(point.normal) < 0) continue;
            leaving.push_back({point.position + point.offset * point.normal, direction, FAR});
        }
        size_t again = 0;
        for (const TraceHit& hit : tracer.closest(leaving))
            again += hit.primitive == NO_PRIMITIVE ? 0 : 1;
        EXPECT_EQ(again, 0u) << "of " << leaving.size();
    }
}

// The offset grows with size and distance, not with the shape: gamma_7 |P| sqrt(3) + gamma_4 length, to rounding.
TEST_F(SurfaceStage, SliversAreLiftedNoHigherThanOtherTriangles) {
    SurfaceProbe probe(device());
    ProgramLibrary library(device());
    for (const Corners& corners : shapes()) {
        DeviceTracer tracer(device(), library, build_bvh(lone_triangle(corners)));
        std::vector<TraceRay> rays;
        std::vector<TraceHit> hits;
        hit_everywhere(tracer, corners, rays, hits);
        const float reach = corners.a.length() + 1.1f;
        const std::vector<Point> points = probe.points(corners, rays, hits);
        for (size_t i = 0; i < points.size(); ++i) {
            // Beside the edges of the thinnest, weights of 2 and -1 make the position less certain.
            if (hits[i].u < 0 || hits[i].v < 0 || hits[i].u + hits[i].v > 1) continue;
            ASSERT_GT(points[i].offset, 0);
            ASSERT_LT(points[i].offset, 0x1p-24f * (7 * 1.74f * reach + 4 * 1.1f));
        }
    }
}

TEST_F(SurfaceStage, NormalsOfSliversAreThoseOfTheirCorners) {
    SurfaceProbe probe(device());
    ProgramLibrary library(device());
    const std::vector<Corners> all = shapes();
    for (const Corners& corners :
         {all.front(), all.back(), Corners{{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 1e-7f}}}) {
        const V3d expected =
            (V3d(corners.b) - V3d(corners.a)).cross(V3d(corners.c) - V3d(corners.a)).normalized();
        const TraceRay ray{V3f(0), V3f(-expected), FAR};
        const TraceHit hit{1, 0.25f, 0.25f, 0};
        const Point point = probe.points(corners, {ray}, {hit}).at(0);
        EXPECT_LT((V3d(point.normal) - expected).length(), 1e-6);
    }
}

// Halfway between two vertices whose normals are opposite their sum is zero: no direction.
TEST_F(SurfaceStage, NormalsThatCancelLeaveTheGeometricOne) {
    constexpr const char* SOURCE = R"(
#define NEED_SMOOTH_NORMALS 1
#include "lib/surface.clh"
kernel void probe(global const SceneTriangle* triangle, global float4* out, uint count) {
    if ((uint)get_global_id(0) >= count) return;
    out[0] = (float4)(make_surface(triangle, 0.5f, 0.0f, (float3)(0.6f, 0.0f, -0.8f)).n_shade, 0.0f);
})";
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("normal probe", SOURCE, "probe");
    SceneTriangle triangle{};
    triangle.corner[1].x = 1;
    triangle.corner[2].y = 1;
    triangle.corner[2].w = 1;
    triangle.normal[0] = {1, 0, 0, 0};
    triangle.normal[1] = {-1, 0, 0, 0};
    triangle.normal[2] = {0, 0, 1, 0};
    triangle.ids = {0, NO_LIGHT, TRIANGLE_SMOOTH, 0};
    const Buffer in = Buffer::holding(device(), "triangle", "test", std::vector<SceneTriangle>{triangle});
    const Buffer out(device(), "normal", "test", sizeof(f32x4));
    launch(device(), kernel, "normal probe", 1, library.local_size(), in, out, 1u);
    const f32x4 n = out.contents<f32x4>().at(0);
    EXPECT_FLOAT_EQ(n.x, 0);
    EXPECT_FLOAT_EQ(n.y, 0);
    EXPECT_FLOAT_EQ(n.z, 1);
}

// A row of four grey texels, read at texture coordinates that no int holds: some texel's colour, for every wrapping.
TEST_F(SurfaceStage, FarTextureCoordinatesGiveAColourOfTheTexture) {
    constexpr const char* SOURCE = R"(
#include "lib/surface.clh"
kernel void probe(global const uchar4* texels, global const float* tables, global const float2* uv, global float4* out,
                  uint bits, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) return;
    out[i] = (float4)(sample_texture(texels, tables, (uint4)(0u, 4u, 1u, bits), uv[i]), 0.0f);
})";
    ProgramLibrary library(device());
    const cl::Kernel kernel = library.kernel_from_text("texture probe", SOURCE, "probe");
    std::vector<float> uv;
    for (const float x : {1e8f, 1e9f, 3e9f, 1e20f, 3e38f, FAR, std::numeric_limits<float>::quiet_NaN()})
        for (const float sign : {1.0f, -1.0f})
            uv.insert(uv.end(), {sign * x, 0.5f, 0.5f, sign * x});
    const auto count = static_cast<uint32_t>(uv.size() / 2);
    const std::vector<uint8_t> texels{60,  60,  60,  255, 90,  90,  90,  255,
                                      120, 120, 120, 255, 150, 150, 150, 255};
    std::vector<float> tables(TABLE_FLOATS);
    for (uint32_t code = 0; code < SRGB_TABLE_FLOATS; ++code)
        tables[TABLE_SRGB + code] = static_cast<float>(code);
    const Buffer texel_buffer = Buffer::holding(device(), "texels", "test", texels);
    const Buffer table_buffer = Buffer::holding(device(), "tables", "test", tables);
    const Buffer uv_buffer = Buffer::holding(device(), "uv", "test", uv);
    for (const uint32_t wrap : {TEXTURE_WRAP_REPEAT, TEXTURE_WRAP_MIRROR, TEXTURE_WRAP_CLAMP}) {
        for (const uint32_t filter : {0u, TEXTURE_LINEAR}) {
            const Buffer out(device(), "colours", "test", count * sizeof(f32x4));
            const uint32_t bits = wrap | wrap << TEXTURE_WRAP_V_SHIFT | filter;
            launch(device(), kernel, "texture probe", count, library.local_size(), texel_buffer, table_buffer,
                   uv_buffer, out, bits, count);
            for (const f32x4& color : out.contents<f32x4>())
                EXPECT_TRUE(color.x >= 60 && color.x <= 150) << color.x << ", wrap " << wrap;
        }
    }
}

}  // namespace
}  // namespace obscura
