#include "proto/shm/motion_capture_memory.h"

#include <memory>

namespace cuscus::shm {

std::size_t MotionCaptureMemoryWriter::byte_size(std::uint32_t node_count) {
  return sizeof(MotionCaptureMemoryLayout) + node_count * sizeof(MotionCaptureMemoryLayout::Slot);
}

MotionCaptureMemoryWriter::MotionCaptureMemoryWriter(std::span<std::byte> memory,
                                                     std::uint32_t node_count) {
  write_header(memory, {.magic = MotionCaptureMemoryLayout::kMagic,
                        .version = MotionCaptureMemoryLayout::kVersion,
                        .node_count = node_count,
                        .byte_size = byte_size(node_count)});
  slots_ = {reinterpret_cast<MotionCaptureMemoryLayout::Slot*>(memory.data() +
                                                               sizeof(MotionCaptureMemoryLayout)),
            node_count};
  std::uninitialized_value_construct(slots_.begin(), slots_.end());
}

void MotionCaptureMemoryWriter::publish(std::uint32_t node,
                                        const MotionCaptureReading& reading) noexcept {
  slots_[node].reading.store(reading);
}

MotionCaptureMemoryReader::MotionCaptureMemoryReader(std::span<const std::byte> memory) {
  const Header header = checked_header(memory, MotionCaptureMemoryLayout::kMagic,
                                       MotionCaptureMemoryLayout::kVersion);
  if (MotionCaptureMemoryWriter::byte_size(header.node_count) != memory.size()) {
    throw LayoutError{"motion-capture memory: its size does not fit its number of nodes"};
  }
  slots_ = {reinterpret_cast<const MotionCaptureMemoryLayout::Slot*>(
                memory.data() + sizeof(MotionCaptureMemoryLayout)),
            header.node_count};
}

std::uint32_t MotionCaptureMemoryReader::node_count() const noexcept {
  return static_cast<std::uint32_t>(slots_.size());
}

std::optional<MotionCaptureReading> MotionCaptureMemoryReader::reading(
    std::uint32_t node) const noexcept {
  const auto reading = slots_[node].reading.load();
  return reading && reading->sequence != 0 ? reading : std::nullopt;
}

}  // namespace cuscus::shm
