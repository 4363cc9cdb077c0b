#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"

namespace cuscus::shm {

/// When the run began: how each process turns the host's clock into SimTime.
struct alignas(kCacheLine) ClockPageLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSCLOCK");
  static constexpr std::uint32_t kVersion = 1;

  Header header;
  /// CLOCK_MONOTONIC at SimTime 0 [ns]; 0 until the run starts. Written once, by the orchestrator.
  std::atomic<std::int64_t> start_monotonic_ns;
};

/// The orchestrator's side.
class ClockPageWriter {
 public:
  [[nodiscard]] static constexpr std::size_t byte_size() { return sizeof(ClockPageLayout); }

  /// Lays the page out in `memory`, which must outlive this object.
  explicit ClockPageWriter(std::span<std::byte> memory);

  void start(std::int64_t monotonic_ns) noexcept;

 private:
  ClockPageLayout* page_;
};

/// Everybody else's side.
class ClockPageReader {
 public:
  /// @throws LayoutError when `memory` is not a clock page.
  explicit ClockPageReader(std::span<const std::byte> memory);

  /// CLOCK_MONOTONIC at SimTime 0 [ns]; nothing before the run has started.
  [[nodiscard]] std::optional<std::int64_t> start_monotonic_ns() const noexcept;

 private:
  const ClockPageLayout* page_;
};

}  // namespace cuscus::shm
