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
/// in the order of their stamps, but the kernel may lose some on the way, and some carry no stamp.
class StampMatcher {
 public:
  /// A stamp was read; `token` is the caller's name for the frame to come.
  void expect(std::uint32_t token, const shm::SendStamp& stamp);

  struct Match {
    std::optional<std::uint32_t> token;  ///< Nothing: a frame without stamp.
    /// Frames announced before this one that can come no more; valid until the next call.
    std::span<const std::uint32_t> lost;
  };

  /// A frame came out of the TAP. The earliest stamp of its length and head is its own; frames of
  /// stamps before that one were lost.
  [[nodiscard]] Match match(std::span<const std::uint8_t> frame);

  /// Gives up on frames stamped before `monotonic_ns`; valid until the next call.
  [[nodiscard]] std::span<const std::uint32_t> expire(std::uint64_t monotonic_ns);

  [[nodiscard]] std::size_t expected() const { return stamps_.size(); }

 private:
  struct Expected {
    std::uint32_t token;
    shm::SendStamp stamp;
  };

  std::span<const std::uint32_t> drop_first(std::size_t count);

  std::deque<Expected> stamps_;
  std::vector<std::uint32_t> lost_;
};

}  // namespace cuscus::netsim
