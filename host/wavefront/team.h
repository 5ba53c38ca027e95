// SPDX-License-Identifier: Apache-2.0
// The devices of a render, and how they share its work.
#pragma once

#include "wavefront/device_render.h"
#include "wavefront/render.h"
#include "wavefront/work_list.h"

#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace obscura {

class Team {
  public:
    // sample_count: of the whole render. job and after_wave must live as long as the team.
    Team(std::span<const RenderDevice> devices, const RenderJob& job, const Needs& needs,
         uint64_t sample_count, const RenderCallback& after_wave);

    void upload(const SceneArrays& arrays, const Bvh& bvh, const QueueShape& shape, const PieceSize& piece);

    // Renders the pieces of the list, into film, from which read_sums() has them, and their visits, if there are any, into
    // pixel_nodes. Leaves the rest when it is stopped; where a device fails, the others are stopped and its error is thrown.
    void render(const Frame& frame, std::span<const uint32_t> pixel_order, WorkList& list,
                std::vector<FilmRange>& film, PixelNodes& pixel_nodes);

    // The sums of a range that has been rendered, until the call ends.
    void read_sums(const FilmRange& range, uint32_t pixel_count,
                   const std::function<void(std::span<const FilmSum>)>& use) const;

    std::vector<DeviceWork> work() const;

  private:
    // Then the one range of a frame stays where it is.
    bool is_one() const { return members_.size() == 1; }
    void take_pieces(size_t member, const Frame& frame, std::span<const uint32_t> pixel_order, WorkList& list,
                     std::vector<FilmRange>& film);
    // The member has finished so many samples more, and has traced these rays in all. False: stop.
    bool report(size_t member, uint64_t samples, const RayCounts& rays);

    std::vector<std::unique_ptr<DeviceRender>> members_;
    const RenderCallback& after_wave_;
    std::mutex mutex_;  // of all below
    uint64_t sample_count_, samples_done_ = 0;
    std::vector<RayCounts> rays_;
};

}  // namespace obscura
