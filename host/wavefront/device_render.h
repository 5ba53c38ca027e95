// SPDX-License-Identifier: Apache-2.0
// A device's part in a render: the scene and its queues in the device's memory, and the loop that renders pieces of the work
// there.
#pragma once

#include "device/scene_buffers.h"
#include "wavefront/render.h"
#include "wavefront/scheduler.h"
#include "wavefront/visit_recorder.h"
#include "wavefront/work_list.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

// Pixels of a frame that are in one hand at a time, in the order of visits.
struct FilmRange {
    SampleCounts samples;
    // plane * pixels of the range + place in it, while no device has them in its memory.
    std::vector<FilmSum> sums;
};

class DeviceRender {
  public:
    // Compiles what is missing of the kernels. device and job must live as long as this.
    DeviceRender(const RenderDevice& device, const RenderJob& job, const Needs& needs);
    DeviceRender(const DeviceRender&) = delete;
    DeviceRender& operator=(const DeviceRender&) = delete;

    // piece: the largest.
    void upload(const SceneArrays& arrays, const Bvh& bvh, const QueueShape& shape, const PieceSize& piece);

    // Where visits of the next pieces are counted, if they are.
    void count_visits_into(PixelNodes& pixel_nodes);
    // Adds the piece's samples to the sums in the device's memory, which are those of the passes before; fewer if after_wave
    // stops it. Says what samples the range has then.
    SampleCounts render(Frame frame, std::span<const uint32_t> pixel_order, const Piece& piece,
                        const WaveCallback& after_wave);
    // The sums of the piece's range, on their way from the last device and to the next.
    void upload_sums(const FilmRange& range);
    void download_sums(const Piece& piece, FilmRange& range) const;
    // Those in the device's memory, pixel_count to a plane; until the call ends.
    void read_sums(uint32_t pixel_count, const std::function<void(std::span<const FilmSum>)>& use) const;

    DeviceWork work() const;

  private:
    const RenderDevice device_;
    const RenderJob& job_;
    StageKernels kernels_;
    SceneBuffers scene_;
    Queues queues_;
    uint32_t capacity_ = 0;
    Profiler profiler_;
    std::optional<VisitRecorder> visits_;
    std::optional<Scheduler> scheduler_;
};

}  // namespace obscura
