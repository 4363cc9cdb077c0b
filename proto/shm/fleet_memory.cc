#include "proto/shm/fleet_memory.h"

#include <memory>
#include <new>

namespace cuscus::shm {

std::size_t FleetMemoryWriter::byte_size(std::uint32_t node_count) {
  return sizeof(FleetMemoryLayout) + node_count * sizeof(FleetMemoryLayout::Slot);
}

FleetMemoryWriter::FleetMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count)
    : layout_{new (memory.data()) FleetMemoryLayout{}},
      slots_{reinterpret_cast<FleetMemoryLayout::Slot*>(memory.data() + sizeof(FleetMemoryLayout)),
             node_count} {
  write_header(memory, {.magic = FleetMemoryLayout::kMagic,
                        .version = FleetMemoryLayout::kVersion,
                        .node_count = node_count,
                        .byte_size = byte_size(node_count)});
  std::uninitialized_value_construct(slots_.begin(), slots_.end());
}

void FleetMemoryWriter::publish(std::uint32_t node, const NodeState& state) noexcept {
  slots_[node].state.store(state);
}

void FleetMemoryWriter::publish(std::uint32_t node, const CommandTally& commands) noexcept {
  slots_[node].commands.store(commands);
}

void FleetMemoryWriter::publish_progress(std::uint64_t steps, std::uint64_t overruns,
                                         std::int64_t sim_time_ns) noexcept {
  layout_->progress.sim_time_ns.store(sim_time_ns, std::memory_order_relaxed);
  layout_->progress.overruns.store(overruns, std::memory_order_relaxed);
  layout_->progress.steps.store(steps, std::memory_order_release);
}

FleetMemoryReader::FleetMemoryReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const FleetMemoryLayout*>(memory.data())} {
  const Header header =
      checked_header(memory, FleetMemoryLayout::kMagic, FleetMemoryLayout::kVersion);
  if (FleetMemoryWriter::byte_size(header.node_count) != memory.size()) {
    throw LayoutError{"fleet memory: its size does not fit its number of nodes"};
  }
  slots_ = {
      reinterpret_cast<const FleetMemoryLayout::Slot*>(memory.data() + sizeof(FleetMemoryLayout)),
      header.node_count};
}

std::uint32_t FleetMemoryReader::node_count() const noexcept {
  return static_cast<std::uint32_t>(slots_.size());
}

std::optional<NodeState> FleetMemoryReader::state(std::uint32_t node) const noexcept {
  return slots_[node].state.load();
}

std::optional<CommandTally> FleetMemoryReader::commands(std::uint32_t node) const noexcept {
  return slots_[node].commands.load();
}

std::uint64_t FleetMemoryReader::steps() const noexcept {
  return layout_->progress.steps.load(std::memory_order_acquire);
}

std::uint64_t FleetMemoryReader::overruns() const noexcept {
  return layout_->progress.overruns.load(std::memory_order_relaxed);
}

std::int64_t FleetMemoryReader::sim_time_ns() const noexcept {
  return layout_->progress.sim_time_ns.load(std::memory_order_relaxed);
}

}  // namespace cuscus::shm
