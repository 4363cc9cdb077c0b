#include "proto/shm/radio_memory.h"

#include <bit>
#include <memory>
#include <new>

namespace cuscus::shm {
namespace {

constexpr std::size_t kSlotsAt = sizeof(RadioMemoryLayout);

std::size_t links_at(std::uint32_t node_count) {
  return kSlotsAt + node_count * sizeof(RadioMemoryLayout::Slot);
}

}  // namespace

std::size_t RadioMemoryWriter::byte_size(std::uint32_t node_count) {
  return links_at(node_count) +
         static_cast<std::size_t>(node_count) * node_count * sizeof(std::atomic<std::uint64_t>);
}

RadioMemoryWriter::RadioMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count)
    : layout_{new (memory.data()) RadioMemoryLayout{}},
      slots_{reinterpret_cast<RadioMemoryLayout::Slot*>(memory.data() + kSlotsAt), node_count},
      links_{reinterpret_cast<std::atomic<std::uint64_t>*>(memory.data() + links_at(node_count)),
             static_cast<std::size_t>(node_count) * node_count} {
  write_header(memory, {.magic = RadioMemoryLayout::kMagic,
                        .version = RadioMemoryLayout::kVersion,
                        .node_count = node_count,
                        .byte_size = byte_size(node_count)});
  std::uninitialized_value_construct(slots_.begin(), slots_.end());
  std::uninitialized_value_construct(links_.begin(), links_.end());
}

void RadioMemoryWriter::publish(std::uint32_t node, const RadioTally& tally) noexcept {
  slots_[node].tally.store(tally);
}

void RadioMemoryWriter::publish(const RadioTiming& timing) noexcept {
  layout_->progress.timing.store(timing);
}

void RadioMemoryWriter::publish_link(std::uint32_t receiver, std::uint32_t sender,
                                     LinkReading reading) noexcept {
  const std::uint64_t word =
      (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(reading.received_dbm)) << 32U) |
      reading.sim_time_ms;
  links_[static_cast<std::size_t>(receiver) * slots_.size() + sender].store(
      word, std::memory_order_relaxed);
}

void RadioMemoryWriter::beat(std::int64_t sim_time_ns) noexcept {
  layout_->progress.sim_time_ns.store(sim_time_ns, std::memory_order_relaxed);
  layout_->progress.heartbeat.fetch_add(1, std::memory_order_release);
}

RadioMemoryReader::RadioMemoryReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const RadioMemoryLayout*>(memory.data())} {
  const Header header =
      checked_header(memory, RadioMemoryLayout::kMagic, RadioMemoryLayout::kVersion);
  const std::uint32_t count = header.node_count;
  if (RadioMemoryWriter::byte_size(count) != memory.size()) {
    throw LayoutError{"radio memory: its size does not fit its number of nodes"};
  }
  slots_ = {reinterpret_cast<const RadioMemoryLayout::Slot*>(memory.data() + kSlotsAt), count};
  links_ = {reinterpret_cast<const std::atomic<std::uint64_t>*>(memory.data() + links_at(count)),
            static_cast<std::size_t>(count) * count};
}

std::uint32_t RadioMemoryReader::node_count() const noexcept {
  return static_cast<std::uint32_t>(slots_.size());
}

std::optional<RadioTally> RadioMemoryReader::tally(std::uint32_t node) const noexcept {
  return slots_[node].tally.load();
}

std::optional<RadioTiming> RadioMemoryReader::timing() const noexcept {
  return layout_->progress.timing.load();
}

std::optional<LinkReading> RadioMemoryReader::link(std::uint32_t receiver,
                                                   std::uint32_t sender) const noexcept {
  const std::uint64_t word =
      links_[static_cast<std::size_t>(receiver) * slots_.size() + sender].load(
          std::memory_order_relaxed);
  if (word == 0) {
    return std::nullopt;
  }
  return LinkReading{.received_dbm = std::bit_cast<float>(static_cast<std::uint32_t>(word >> 32U)),
                     .sim_time_ms = static_cast<std::uint32_t>(word)};
}

std::uint64_t RadioMemoryReader::heartbeat() const noexcept {
  return layout_->progress.heartbeat.load(std::memory_order_acquire);
}

std::int64_t RadioMemoryReader::sim_time_ns() const noexcept {
  return layout_->progress.sim_time_ns.load(std::memory_order_relaxed);
}

}  // namespace cuscus::shm
