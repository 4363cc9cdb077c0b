#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "netsim/app/due_copies.h"
#include "netsim/kernel/slot_pool.h"

namespace cuscus::netsim {

/// A frame between its send and the last copy of it.
struct LiveFrame {
  enum class Payload : std::uint8_t { kAwaited, kHere, kLost };

  std::uint32_t node{};
  std::uint32_t serial{};  ///< Counts the frames of a run, from 1.
  std::uint32_t frame_bytes{};
  std::int64_t sent_ns{};
  Payload payload{Payload::kAwaited};
  bool air_done{false};       ///< The air needs it no more.
  std::uint32_t copies{0};    ///< Due and not written yet.
  std::uint32_t records{0};   ///< PPDUs of it that a PpduRecorder holds back.
  std::vector<DueCopy> late;  ///< Due while the payload is still awaited.
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] bool over() const {
    return air_done && copies == 0 && records == 0 && payload != Payload::kAwaited;
  }
};

/// Frames by number; numbers and buffers are used again.
class FrameStore {
 public:
  [[nodiscard]] std::uint32_t add(std::uint32_t node, std::uint32_t frame_bytes,
                                  std::int64_t sent_ns) {
    const std::uint32_t number = frames_.take();
    LiveFrame& frame = frames_[number];
    frame.node = node;
    frame.serial = ++serial_;
    frame.frame_bytes = frame_bytes;
    frame.sent_ns = sent_ns;
    frame.payload = LiveFrame::Payload::kAwaited;
    frame.air_done = false;
    frame.copies = 0;
    frame.records = 0;
    frame.late.clear();
    frame.bytes.clear();
    return number;
  }

  /// Of no other frame of a run, unlike its number, which is the lower half of this.
  [[nodiscard]] std::uint64_t id_of(std::uint32_t number) const {
    return std::uint64_t{frames_[number].serial} << 32U | number;
  }

  [[nodiscard]] LiveFrame& operator[](std::uint32_t number) { return frames_[number]; }

  /// Gives the number back if its frame is over.
  void drop_if_over(std::uint32_t number) {
    if (frames_[number].over()) {
      frames_.give_back(number);
    }
  }

  [[nodiscard]] std::size_t in_use() const { return frames_.in_use(); }

 private:
  SlotPool<LiveFrame> frames_;
  std::uint32_t serial_{0};
};

}  // namespace cuscus::netsim
