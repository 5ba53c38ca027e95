// SPDX-License-Identifier: Apache-2.0
// Reading the table; its values are written at build time (tabulate_albedo.cpp).
#include "scene/albedo_table.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr double LAST = static_cast<double>(AlbedoTable::SIZE - 1);

AlbedoTerms lerp(const AlbedoTerms& x, const AlbedoTerms& y, double t) {
    return {(1 - t) * x.a + t * y.a, (1 - t) * x.b + t * y.b};
}

// Column i of the table, interpolated between rows.
AlbedoTerms table_column(size_t i, double alpha) {
    const double row = std::sqrt(alpha) * LAST;
    const size_t j = std::min(static_cast<size_t>(row), AlbedoTable::SIZE - 2);
    const auto entry = [i](size_t r) {
        const float* pair = ALBEDO_TABLE.values.data() + 2 * (r * AlbedoTable::SIZE + i);
        return AlbedoTerms{static_cast<double>(pair[0]), static_cast<double>(pair[1])};
    };
    return lerp(entry(j), entry(j + 1), row - static_cast<double>(j));
}

}  // namespace

AlbedoTerms directional_albedo(double mu, double alpha) {
    if (alpha == 0) return schlick_albedo(mu);
    const double column = mu * LAST;
    const size_t i = std::min(static_cast<size_t>(column), AlbedoTable::SIZE - 2);
    return lerp(table_column(i, alpha), table_column(i + 1, alpha), column - static_cast<double>(i));
}

AlbedoTerms mean_albedo(double alpha) {
    if (alpha == 0) return {20.0 / 21, 1.0 / 21};
    AlbedoTerms mean;
    const double h = 1 / LAST;
    for (size_t i = 0; i + 1 < AlbedoTable::SIZE; ++i) {
        // 2 int mu f dmu over one column, f linear.
        const AlbedoTerms left = table_column(i, alpha), right = table_column(i + 1, alpha);
        const double mu = static_cast<double>(i) * h;
        const double left_weight = h * (mu + h / 3);
        const double right_weight = h * (mu + 2 * h / 3);
        mean.a += left_weight * left.a + right_weight * right.a;
        mean.b += left_weight * left.b + right_weight * right.b;
    }
    return mean;
}

}  // namespace obscura
