// SPDX-License-Identifier: Apache-2.0
// A scene's triangles as an Embree scene of the highest build quality, and what it cost to build.
#pragma once

#include "scene/scene.h"

#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

namespace obscura {

// No coordinate of a ray may be larger, or Embree aborts: its FLT_LARGE.
inline constexpr float EMBREE_LARGEST = 1.844e18f;

// For every ray before Embree sees it. Throws InputError that names what lies too far away: only a camera ray starts
// beyond the scene, and only a shadow ray's direction is as long as its way.
void check_embree_limit(const V3f& origin, const V3f& direction);

// Whether occlusion ends at panes as elsewhere, or passes through them by a filter function. Then hits don't tell which of the
// scene's triangles they are of.
enum class EmbreePanes { solid, passed };

class EmbreeScene {
  public:
    // Copies what it needs. robust: watertight intersection, as ours is; else Embree's quickest.
    explicit EmbreeScene(const Scene& scene, bool robust = true, EmbreePanes panes = EmbreePanes::solid);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }
    double build_seconds() const { return build_seconds_; }
    // Of its BVH, as Embree reports its memory: without vertices and indices, which it shares with this object.
    uint64_t bytes() const { return static_cast<uint64_t>(bytes_.load()); }

    // Where rays start: Embree's ends are inclusive, ours starts at 0 exclusive. Without denormals t > 0 is the same.
    static constexpr float T_NEAR = std::numeric_limits<float>::min();

  private:
    // The indices from first to last - 1.
    void attach_mesh(size_t first, size_t last, EmbreePanes panes);

    std::vector<V3f> positions_;
    std::vector<std::array<uint32_t, 3>> indices_;
    std::atomic<int64_t> bytes_ = 0;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    double build_seconds_ = 0;
};

}  // namespace obscura
