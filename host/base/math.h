// SPDX-License-Identifier: Apache-2.0
// The host's vectors, matrices and boxes are Imath's. Imath multiplies row vectors from the left: a point p
// is transformed as p * M, and a child's world matrix is local * parent.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <cstdint>

namespace obscura {

using Imath::Box3d;
using Imath::Box3f;
using Imath::M44d;
using Imath::V2f;
using Imath::V2i;
using Imath::V3d;
using Imath::V3f;

// Linear RGB; the unit stands where it is used.
using Rgb = Imath::V3f;
using RgbD = Imath::V3d;

}  // namespace obscura
