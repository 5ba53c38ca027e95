// SPDX-License-Identifier: Apache-2.0
#include "wavefront/team.h"

#include <future>
#include <optional>
#include <utility>

namespace obscura {

Team::Team(std::span<const RenderDevice> devices, const RenderJob& job, const Needs& needs,
           uint64_t sample_count, const RenderCallback& after_wave)
    : after_wave_(after_wave), sample_count_(sample_count), rays_(devices.size()) {
    // One after the other: sub-devices find in the cache what the first of them has compiled.
    for (const RenderDevice& device : devices)
        members_.push_back(std::make_unique<DeviceRender>(device, job, needs));
}

void Team::upload(const SceneArrays& arrays, const Bvh& bvh, const QueueShape& shape,
                  const PieceSize& piece) {
    for (const auto& member : members_)
        member->upload(arrays, bvh, shape, piece);
}

void Team::render(const Frame& frame, std::span<const uint32_t> pixel_order, WorkList& list,
                  std::vector<FilmRange>& film, PixelNodes& pixel_nodes) {
    for (const auto& member : members_)
        member->count_visits_into(pixel_nodes);
    // One device stays in this thread: Oclgrind 21.10 crashes when another thread than the one that opened it uses it.
    if (is_one()) return take_pieces(0, frame, pixel_order, list, film);
    std::vector<std::future<void>> at_work;
    at_work.reserve(members_.size());
    for (size_t member = 0; member < members_.size(); ++member)
        at_work.push_back(std::async(std::launch::async, [&, member] {
            try {
                take_pieces(member, frame, pixel_order, list, film);
            } catch (...) {
                list.stop();
                throw;
            }
        }));
    for (const std::future<void>& member : at_work)
        member.wait();
    for (std::future<void>& member : at_work)
        member.get();
}

void Team::take_pieces(size_t member, const Frame& frame, std::span<const uint32_t> pixel_order,
                       WorkList& list, std::vector<FilmRange>& film) {
    while (const std::optional<Piece> piece = list.take()) {
        uint64_t done_before = 0;
        const auto after_wave = [&](uint64_t done, const RayCounts& rays) {
            if (!report(member, done - std::exchange(done_before, done), rays)) list.stop();
            return !list.is_stopped();
        };
        FilmRange& range = film[piece->range];
        if (piece->first_pass > 0) members_[member]->upload_sums(range);
        range.samples = members_[member]->render(frame, pixel_order, *piece, after_wave);
        if (!is_one()) members_[member]->download_sums(*piece, range);
        list.finish(*piece);
    }
}

bool Team::report(size_t member, uint64_t samples, const RayCounts& rays) {
    const std::lock_guard lock(mutex_);
    samples_done_ += samples;
    rays_[member] = rays;
    RayCounts sum;
    for (const RayCounts& of_member : rays_)
        sum += of_member;
    const double fraction = static_cast<double>(samples_done_) / static_cast<double>(sample_count_);
    return after_wave_(fraction, sum) || samples_done_ == sample_count_;
}

void Team::read_sums(const FilmRange& range, uint32_t pixel_count,
                     const std::function<void(std::span<const FilmSum>)>& use) const {
    if (is_one()) return members_.front()->read_sums(pixel_count, use);
    use(range.sums);
}

std::vector<DeviceWork> Team::work() const {
    std::vector<DeviceWork> work;
    work.reserve(members_.size());
    for (const auto& member : members_)
        work.push_back(member->work());
    return work;
}

}  // namespace obscura
