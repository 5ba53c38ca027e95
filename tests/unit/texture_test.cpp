// SPDX-License-Identifier: Apache-2.0
// Means of textures over triangles of texture space: closed forms, and many samples for every wrap and filter
// mode.
#include "scene/texture.h"

#include <gtest/gtest.h>

#include <random>

namespace obscura {
namespace {

Texture noise_texture(uint32_t width, uint32_t height, Wrap wrap_u, Wrap wrap_v, TextureFilter filter) {
    Texture texture{"noise", width, height, wrap_u, wrap_v, filter, {}};
    std::mt19937 random(width * 31 + height);
    for (uint32_t i = 0; i < 4 * width * height; ++i)
        texture.rgba.push_back(static_cast<uint8_t>(random() >> 24));
    return texture;
}

TEST(TextureMean, ConstantTextureIsExact) {
    Texture texture{"grey", 3, 5, Wrap::repeat, Wrap::clamp_to_edge, TextureFilter::linear, {}};
    texture.rgba.assign(60, 100);
    const TextureIntegral integral(texture);
    for (const auto& uv : {std::array{V2f(0, 0), V2f(1, 0), V2f(0, 1)},
                           {V2f(-3, 2), V2f(7.5f, 2.25f), V2f(0, -9)},
                           {V2f(0.1f, 0.1f), V2f(0.1f, 0.1f), V2f(0.1f, 0.1f)}})
        EXPECT_NEAR(integral.mean(uv).x, srgb_to_linear(100), 1e-12);
}

TEST(TextureMean, WholeTextureIsTheMeanOfItsTexels) {
    for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
        const Texture texture = noise_texture(7, 4, Wrap::repeat, Wrap::repeat, filter);
        RgbD expected(0, 0, 0);
        for (size_t i = 0; i < 28; ++i)
            for (size_t c = 0; c < 3; ++c)
                expected[static_cast<int>(c)] += srgb_to_linear(texture.rgba[4 * i + c]) / 28;
        const TextureIntegral integral(texture);
        const RgbD lower = integral.mean({V2f(0, 0), V2f(1, 0), V2f(1, 1)});
        const RgbD upper = integral.mean({V2f(0, 0), V2f(1, 1), V2f(0, 1)});
        const RgbD tiled = integral.mean({V2f(-3, 0), V2f(5, 0), V2f(-3, 6)}) +
                           integral.mean({V2f(5, 0), V2f(5, 6), V2f(-3, 6)});
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR((lower[c] + upper[c]) / 2, expected[c], 1e-12);
            EXPECT_NEAR(tiled[c] / 2, expected[c], 1e-12);
        }
    }
}

TEST(TextureMean, AgreesWithManySamples) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-2, 2);
    for (const Wrap wrap_u : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
        for (const Wrap wrap_v : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
            for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
                const Texture texture = noise_texture(5, 3, wrap_u, wrap_v, filter);
                const TextureIntegral integral(texture);
                std::array<V2f, 3> uv;
                for (V2f& corner : uv)
                    corner = V2f(coordinate(random), coordinate(random));
                RgbD sum(0, 0, 0);
                const int n = 400;
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; i + j < n; ++j) {
                        for (const double third : {1.0 / 3, 2.0 / 3}) {
                            if (third > 0.5 && i + j + 1 == n) continue;
                            const double a = (i + third) / n, b = (j + third) / n;
                            const Imath::V2d at = Imath::V2d(uv[0]) + a * Imath::V2d(uv[1] - uv[0]) +
                                                  b * Imath::V2d(uv[2] - uv[0]);
                            sum += integral.sample(5 * at.x, 3 * at.y);
                        }
                    }
                }
                const RgbD mean = integral.mean(uv);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(mean[c], sum[c] / (n * n), 2e-3);
            }
        }
    }
}

TEST(TextureMean, HugeCoordinatesStayFinite) {
    const Texture texture = noise_texture(4, 4, Wrap::repeat, Wrap::repeat, TextureFilter::linear);
    const TextureIntegral integral(texture);
    for (const float size : {1e4f, 1e6f, 1e12f, 3e38f}) {
        const RgbD mean = integral.mean({V2f(0, 0), V2f(size, 0), V2f(0, size)});
        EXPECT_TRUE(mean.x > 0 && mean.x < 1) << size;
    }
}

}  // namespace
}  // namespace obscura
