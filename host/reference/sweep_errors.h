// SPDX-License-Identifier: Apache-2.0
// How far renders are from a reference that is noisy itself. With I the render, R the reference, and means over the
// pixels and the channels R, G, B of a layer, the errors are those of film/metrics.h:
//
//   mse = mean (I - R)^2     relmse = mean (I - R)^2 / (R^2 + 0.01)     mape = mean |I - R| / (|R| + 0.01)
//   bias = mean (I - R)
//
// Two renders I and J with independent seeds tell noise from bias: mean (I - R)(J - R), the common part of mse, is on average
// the square of the bias per pixel and channel, and mse without it the variance. So it is with relmse.
#pragma once

#include "film/image.h"

namespace obscura {

struct LayerErrors {
    double mse = 0, relmse = 0, mape = 0, bias = 0;
};

// What the errors of two renders have in common.
struct CommonErrors {
    double mse = 0, relmse = 0;
};

// The part of these errors that is the reference's own: what its variance adds to each on average, and the standard error
// of its mean over pixels and channels.
struct ReferenceNoise {
    double mse = 0, relmse = 0, mean_error = 0;
};

// Of layers of the same size that have channels R, G, B; others (alpha) don't count.
LayerErrors measure_errors(const Layer& render, const Layer& reference);
CommonErrors measure_common_errors(const Layer& render, const Layer& other, const Layer& reference);
// variance: of the reference's values.
ReferenceNoise measure_noise(const Layer& reference, const Layer& variance);

}  // namespace obscura
