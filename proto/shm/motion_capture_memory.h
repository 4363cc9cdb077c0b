#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/seqlock.h"
#include "proto/shm/vehicle_memory.h"

namespace cuscus::shm {

/// The motion-capture system's view of every body, as a laboratory broadcasts it. The world writes;
/// agents read it only where the scenario says that neighbours are known by motion capture.
struct MotionCaptureMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSMOCAP");
  static constexpr std::uint32_t kVersion = 1;

  struct alignas(kCacheLine) Slot {
    Seqlock<MotionCaptureReading> reading;
  };

  Header header;
  // Slots follow, one per node of the run.
};

class MotionCaptureMemoryWriter {
 public:
  [[nodiscard]] static std::size_t byte_size(std::uint32_t node_count);
  MotionCaptureMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count);

  void publish(std::uint32_t node, const MotionCaptureReading& reading) noexcept;

 private:
  std::span<MotionCaptureMemoryLayout::Slot> slots_;
};

class MotionCaptureMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not motion-capture memory.
  explicit MotionCaptureMemoryReader(std::span<const std::byte> memory);

  [[nodiscard]] std::uint32_t node_count() const noexcept;
  /// Nothing before the first reading. `node` < node_count().
  [[nodiscard]] std::optional<MotionCaptureReading> reading(std::uint32_t node) const noexcept;

 private:
  std::span<const MotionCaptureMemoryLayout::Slot> slots_;
};

}  // namespace cuscus::shm
