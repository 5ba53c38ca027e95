// SPDX-License-Identifier: Apache-2.0
// From linear radiance to the eight bits of a preview:
//
//   1. exposure: times 2^stops;
//   2. tone curve on p, the largest of R, G and B (after the Khronos PBR Neutral tone mapper, 2024, without its
//      Fresnel offset and with an earlier shoulder): what is below 0.5 stays as it is, mid grey 0.18 too;
//      above, p' = 1 - 0.25 / p, which joins with equal slope and reaches 1 at infinity. All channels are
//      scaled by p' / p, so hue and saturation stay; then they are mixed with white p' by
//      1 - 1 / (1 + 0.15 (p - p')), so that very bright colours fade to white as film does;
//   3. the sRGB transfer curve (IEC 61966-2-1);
//   4. ordered dithering with Bayer's 8 x 8 matrix, by the pixel's place in the whole picture: no bands in soft
//      gradients, the same bits every time, and a value that 8 bits hold exactly is left alone.
//
// Negative values are black. A pixel with a NaN or an infinity is magenta.
#pragma once

#include "base/math.h"
#include "film/png.h"

namespace obscura {

inline constexpr Rgb8 NOT_FINITE_COLOR = {255, 0, 255};

// Step 2: linear, not negative -> linear in [0, 1].
Rgb tone_curve(const Rgb& linear);

// Step 3: [0, 1] -> [0, 1].
float srgb_encode(float linear);

// All steps for the pixel at x, y of the whole picture; scale is 2^stops.
Rgb8 preview_color(const Rgb& radiance, float scale, int32_t x, int32_t y);

}  // namespace obscura
