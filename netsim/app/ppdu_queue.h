#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "netsim/capture/ppdu_record.h"

namespace cuscus::netsim {

/// PPDUs and the Ethernet frames that they carry, on their way from one thread to another, which
/// may be slow: the memory between them is bounded, and add() never waits.
class PpduQueue {
 public:
  explicit PpduQueue(std::size_t capacity_bytes) : memory_(capacity_bytes) {}

  /// From one thread. False when there is no room.
  [[nodiscard]] bool add(const PpduRecord& record, std::span<const std::uint8_t> ethernet) noexcept;

  /// From another. Hands all that was added by now to `take(record, ethernet)`.
  template <typename Take>
  void drain(const Take& take) {
    const std::uint64_t end = added_.load(std::memory_order_acquire);
    while (taken_.load(std::memory_order_relaxed) < end) {
      const PpduRecord record = next();
      take(record, std::span<const std::uint8_t>{ethernet_});
    }
  }

 private:
  [[nodiscard]] PpduRecord next();
  void write(std::uint64_t position, std::span<const std::byte> bytes) noexcept;
  void read(std::uint64_t position, std::span<std::byte> bytes) const noexcept;

  std::vector<std::byte> memory_;  ///< A ring; positions count on.
  std::atomic<std::uint64_t> added_{0};
  std::atomic<std::uint64_t> taken_{0};
  std::vector<std::uint8_t> ethernet_;  ///< Of the record that was taken last.
};

}  // namespace cuscus::netsim
