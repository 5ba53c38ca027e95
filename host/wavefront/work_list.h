// SPDX-License-Identifier: Apache-2.0
// The work that several devices share: pieces of a frame's samples, which each takes as it comes to them, the faster the
// more. A pixel's sums go from device to device with the pixel, and a pixel is never in two hands: its samples are added in
// their order, and no bit of the picture depends on who took what.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

namespace obscura {

// Some passes over a range of pixels, in the order of visits.
struct Piece {
    uint32_t range = 0;  // its number in the list
    uint32_t first_pixel = 0, pixel_count = 0;
    uint32_t first_pass = 0, pass_count = 0;
    uint64_t sample_count() const { return uint64_t{pixel_count} * pass_count; }
};

struct PieceSize {
    uint32_t pixel_count, pass_count;
};

// The largest piece of a list: one device takes all at once, several take waves (samples), and smaller ones than that where
// the work is too little to come out even at the end.
PieceSize piece_size(uint32_t pixel_count, uint32_t pass_count, uint64_t wave_size, size_t device_count);

class WorkList {
  public:
    WorkList(uint32_t pixel_count, uint32_t pass_count, PieceSize size);

    uint32_t range_count() const { return range_count_; }

    // A piece of a range with the fewest passes, so that a render that is stopped has about as many samples everywhere.
    // Waits while the work that is left is in other hands. Nothing: there is no more, or the list was stopped.
    std::optional<Piece> take();
    // The piece is done, or left after a stop: the rest of its range can be taken.
    void finish(const Piece& piece);
    // What is in hand is to be left, and nothing more is taken.
    void stop();
    bool is_stopped() const;

  private:
    uint32_t pixel_count_, pass_count_;
    PieceSize size_;
    uint32_t range_count_;
    mutable std::mutex mutex_;  // of all below
    std::condition_variable changed_;
    std::set<std::pair<uint32_t, uint32_t>> ranges_;  // passes done, number: those in nobody's hands
    uint32_t in_hand_ = 0;
    bool stopped_ = false;
};

}  // namespace obscura
