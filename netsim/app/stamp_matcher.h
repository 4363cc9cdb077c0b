#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "proto/shm/send_stamp.h"

namespace cuscus::netsim {

/// Finds for each frame that comes out of one node's TAP the stamp that announced it. Frames come
/// nearly in the order of their stamps: two processors that send at once may swap theirs between
/// the stamp and the TAP. The kernel may lose some on the way, and some carry no stamp.
class StampMatcher {
 public:
  /// A frame stamped this much earlier than one that came after all was lost, not overtaken.
  static constexpr std::uint64_t kOvertaking_ns = 5'000'000;
  /// Stamps among which a frame's own is looked for. A TAP holds 1000 frames; beyond this lie those
  /// of a node that floods, whose frames then count as unstamped.
  static constexpr std::size_t kDepth = 4096;

  /// A stamp was read; `token` is the caller's name for the frame to come.
  void expect(std::uint32_t token, const shm::SendStamp& stamp);

  struct Match {
    std::optional<std::uint32_t> token;  ///< Nothing: a frame without stamp.
    /// Frames announced before this one that can come no more; valid until the next call.
    std::span<const std::uint32_t> lost;
  };

  /// A frame came out of the TAP. The earliest stamp of its length and head is its own; frames of
  /// stamps kOvertaking_ns before that one were lost.
  [[nodiscard]] Match match(std::span<const std::uint8_t> frame);

  /// Whether a frame stamped before `monotonic_ns` is still expected.
  [[nodiscard]] bool overdue(std::uint64_t monotonic_ns) const {
    return !stamps_.empty() && stamps_.front().stamp.monotonic_ns < monotonic_ns;
  }
  /// Gives up on frames stamped before `monotonic_ns`; valid until the next call.
  [[nodiscard]] std::span<const std::uint32_t> expire(std::uint64_t monotonic_ns);

  [[nodiscard]] std::size_t expected() const { return stamps_.size(); }

 private:
  struct Expected {
    std::uint32_t token;
    shm::SendStamp stamp;
  };

  std::deque<Expected> stamps_;
  std::vector<std::uint32_t> lost_;
};

}  // namespace cuscus::netsim
