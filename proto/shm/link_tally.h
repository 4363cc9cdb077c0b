#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace cuscus::shm {

/// What is counted of the frames from one sender to one receiver. One that was lost or dropped
/// counts once, whatever it was tried; see RadioTally for the causes.
enum class LinkCount : std::uint8_t {
  kReceived,
  // Lost on the way, by the cause of the last attempt.
  kLostBelowFloor,
  kLostBelowDetection,
  kLostNoise,
  kLostCollision,
  kLostInterference,
  kLostHalfDuplex,
  kLostJammed,
  kLostInterface,
  kLostUnanswered,  ///< Never put on the air: no answer to RTS that had arrived.
  // Given up by the sender. After the last attempt a frame is lost, or even received, as well.
  kDroppedQueueFull,
  kDroppedLifetime,
  kDroppedRetryLimit,
  kTransmissions,  ///< Data frames put on the air, retries included.
};
inline constexpr std::size_t kLinkCounts = 14;
/// The standard's own unit of rates.
inline constexpr std::uint32_t kRateUnit_kbps = 500;

/// Individually addressed frames know their rate per link, group frames per sender.
struct LinkRates {
  std::uint32_t latest_kbps{};  ///< 0: nothing was sent.
  std::uint32_t lowest_kbps{};
  std::uint32_t highest_kbps{};
};

/// What became of the frames on one directed link since the run began.
struct LinkTally {
  std::array<std::uint32_t, kLinkCounts> counts{};
  LinkRates rates{};

  [[nodiscard]] std::uint32_t operator[](LinkCount which) const {
    return counts[static_cast<std::size_t>(which)];
  }
};

/// A LinkTally in shared memory, which one process writes. A line of its own.
class LinkTallySlot {
 public:
  void count(LinkCount which, std::int32_t by = 1) noexcept {
    auto& counter = counts_[static_cast<std::size_t>(which)];
    counter.store(counter.load(std::memory_order_relaxed) + static_cast<std::uint32_t>(by),
                  std::memory_order_relaxed);
  }
  void note_rate(std::uint32_t rate_kbps) noexcept;

  [[nodiscard]] LinkTally load() const noexcept;

 private:
  std::array<std::atomic<std::uint32_t>, kLinkCounts> counts_{};
  /// Latest, lowest and highest rate in units of 500 kb/s, the standard's own, 16 bits each.
  std::atomic<std::uint64_t> rates_{0};
};
static_assert(sizeof(LinkTallySlot) == 64);

}  // namespace cuscus::shm
