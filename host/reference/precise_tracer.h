// SPDX-License-Identifier: Apache-2.0
// Rays in double against the scene's float triangles: the reference renderer's tracer. Embree finds the candidates in
// boxes that are padded by what a ray loses when Embree rounds it to float; every candidate is then tested in double.
#pragma once

#include "base/math.h"
#include "scene/scene.h"
#include "shared/bvh.h"

#include <limits>
#include <memory>
#include <string>

namespace obscura::reference {

// Hits count for 0 < t < t_max.
struct Ray {
    V3d origin;
    V3d direction;  // unit
    double t_max = std::numeric_limits<double>::infinity();
};

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    double u = 0;                       // weight of corner 1
    double v = 0;                       // weight of corner 2
    uint32_t primitive = NO_PRIMITIVE;  // triangle of the scene

    bool found() const { return primitive != NO_PRIMITIVE; }
};

// With its version.
std::string tracer_name();

class PreciseTracer {
  public:
    explicit PreciseTracer(const Scene& scene);  // copies what it needs
    ~PreciseTracer();
    PreciseTracer(const PreciseTracer&) = delete;
    PreciseTracer& operator=(const PreciseTracer&) = delete;

    // The nearest hit; of equally near ones the triangle with the smallest index.
    Hit nearest(const Ray& ray) const;
    bool is_blocked(const Ray& ray) const;

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

}  // namespace obscura::reference
