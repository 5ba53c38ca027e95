// SPDX-License-Identifier: Apache-2.0
#include "wavefront/device_render.h"

#include "sampling/sample_order.h"
#include "wavefront/features.h"

#include <functional>

namespace obscura {
namespace {

StageKernels prepare_kernels(ProgramLibrary& library, const Needs& needs, const RenderJob& job) {
    const bool all = job.settings.needs == NeedsMode::all;
    std::vector<KernelRequest> requests;
    const std::vector<Stage> stages = needed_stages(needs);
    requests.reserve(stages.size());
    for (const Stage stage : stages) {
        requests.push_back(
            {std::string(stage_info(stage).name), stage_options(stage, needs, all, job.portable)});
    }
    const std::vector<cl::Kernel> built = library.kernels(requests);
    StageKernels kernels;
    for (size_t i = 0; i < stages.size(); ++i)
        kernels[static_cast<uint32_t>(stages[i])] = built[i];
    return kernels;
}

std::map<std::string, uint64_t> peak_bytes(const Device& device) {
    std::map<std::string, uint64_t> bytes;
    for (const char* category : {"scene", "bvh", "queues", "film"}) {
        bytes[category] = device.memory().peak_bytes(category);
    }
    bytes["peak_device"] = device.memory().peak_bytes();
    return bytes;
}

}  // namespace

DeviceRender::DeviceRender(const RenderDevice& device, const RenderJob& job, const Needs& needs)
    : device_(device),
      job_(job),
      kernels_(prepare_kernels(device.programs, needs, job)),
      profiler_(device.device.name()) {
    const bool all = job.settings.needs == NeedsMode::all;
    if (job.count_visits) visits_.emplace(device.device, device.programs, needs, all, job.portable, scene_);
}

void DeviceRender::upload(const SceneArrays& arrays, const Bvh& bvh, const QueueShape& shape,
                          const PieceSize& piece) {
    Device& device = device_.device;
    capacity_ = wave_capacity(shape, job_.wave_size, job_.queue_bytes, device.info().max_allocation_bytes,
                              uint64_t{piece.pixel_count} * piece.pass_count);
    scene_ = upload_scene(device, arrays, bvh);
    queues_ =
        allocate_queues(device, shape, capacity_, piece.pixel_count, bit_reversed_order(job_.settings.spp));
    scheduler_.emplace(device, kernels_, scene_, queues_, device_.programs.local_size(), profiler_);
    scheduler_->observe(job_.observer);
    if (visits_) scheduler_->observe(std::bind_front(&VisitRecorder::observe, &*visits_));
}

void DeviceRender::count_visits_into(PixelNodes& pixel_nodes) {
    if (visits_) visits_->count_into(pixel_nodes);
}

SampleCounts DeviceRender::render(Frame frame, std::span<const uint32_t> pixel_order, const Piece& piece,
                                  const WaveCallback& after_wave) {
    frame.crop.z = piece.pixel_count;
    frame.crop.w = capacity_;
    queues_.pixel_order.upload(pixel_order.subspan(piece.first_pixel, piece.pixel_count));
    return scheduler_->render(frame, piece.first_pass, piece.pass_count, after_wave);
}

void DeviceRender::upload_sums(const FilmRange& range) {
    queues_.film.upload(range.sums);
}

void DeviceRender::download_sums(const Piece& piece, FilmRange& range) const {
    range.sums.resize(size_t{piece.pixel_count} * queues_.shape.layer_planes);
    queues_.film.download(range.sums);
}

void DeviceRender::read_sums(uint32_t pixel_count,
                             const std::function<void(std::span<const FilmSum>)>& use) const {
    queues_.film.read_in_place<FilmSum>(size_t{pixel_count} * queues_.shape.layer_planes, use);
}

DeviceWork DeviceRender::work() const {
    DeviceWork work;
    work.rays = scheduler_->rays();
    work.shape = queues_.shape;
    work.profile = profiler_.rows();
    if (visits_) work.visits = visits_->visits();
    work.wave_capacity = capacity_;
    work.bytes = peak_bytes(device_.device);
    return work;
}

}  // namespace obscura
