// SPDX-License-Identifier: Apache-2.0
#include "wavefront/work_list.h"

#include "base/error.h"

#include <algorithm>

namespace obscura {
namespace {

// Pieces that a device takes in a render, at least: at its end the others wait for one of them at most.
constexpr uint64_t PIECES_PER_DEVICE = 32;
// Samples below which a piece is all launch overhead.
constexpr uint64_t MIN_PIECE = 4096;
// Pixels' sums travel to the device and back with each piece: fewer passes would cost more of that, more of them would leave
// more of a stopped picture without samples.
constexpr uint32_t PASSES_PER_PIECE = 4;
// So that those who wait for a range find others.
constexpr uint32_t RANGES_PER_DEVICE = 4;

}  // namespace

PieceSize piece_size(uint32_t pixel_count, uint32_t pass_count, uint64_t wave_size, size_t device_count) {
    if (device_count == 1) return {pixel_count, pass_count};
    const uint64_t share = uint64_t{pixel_count} * pass_count / (PIECES_PER_DEVICE * device_count);
    const uint64_t samples = std::min(wave_size, std::max(share, MIN_PIECE));
    const uint64_t pixels = std::clamp<uint64_t>(std::min(samples / std::min(pass_count, PASSES_PER_PIECE),
                                                          pixel_count / (RANGES_PER_DEVICE * device_count)),
                                                 1, pixel_count);
    const uint64_t passes = std::clamp<uint64_t>(samples / pixels, 1, pass_count);
    return {static_cast<uint32_t>(pixels), static_cast<uint32_t>(passes)};
}

WorkList::WorkList(uint32_t pixel_count, uint32_t pass_count, PieceSize size)
    : pixel_count_(pixel_count),
      pass_count_(pass_count),
      size_(size),
      range_count_((pixel_count - 1) / size.pixel_count + 1) {
    OBSCURA_CHECK(pixel_count > 0 && pass_count > 0 && size.pass_count > 0, "{} passes over {} pixels by {}",
                  pass_count, pixel_count, size.pass_count);
    for (uint32_t range = 0; range < range_count_; ++range)
        ranges_.emplace_hint(ranges_.end(), 0, range);
}

std::optional<Piece> WorkList::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || !ranges_.empty() || in_hand_ == 0; });
    if (stopped_ || ranges_.empty()) return std::nullopt;
    const auto [passes, range] = *ranges_.begin();
    ranges_.erase(ranges_.begin());
    ++in_hand_;
    const uint32_t first_pixel = range * size_.pixel_count;
    return Piece{range, first_pixel, std::min(size_.pixel_count, pixel_count_ - first_pixel), passes,
                 std::min(size_.pass_count, pass_count_ - passes)};
}

void WorkList::finish(const Piece& piece) {
    {
        const std::lock_guard lock(mutex_);
        OBSCURA_CHECK(in_hand_ > 0, "range {} is in nobody's hands", piece.range);
        --in_hand_;
        const uint32_t passes = piece.first_pass + piece.pass_count;
        if (passes < pass_count_) ranges_.emplace(passes, piece.range);
    }
    changed_.notify_all();
}

void WorkList::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
    }
    changed_.notify_all();
}

bool WorkList::is_stopped() const {
    const std::lock_guard lock(mutex_);
    return stopped_;
}

}  // namespace obscura
