#include "proto/shm/radio_memory.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

namespace cuscus::shm {
namespace {

constexpr std::size_t kSlotsAt = sizeof(RadioMemoryLayout);
/// kToGroup and kToNobody.
constexpr std::size_t kMoreReceivers = 2;

std::size_t tallies_at(std::uint32_t node_count) {
  return kSlotsAt + node_count * sizeof(RadioMemoryLayout::Slot);
}

std::size_t tally_count(std::size_t node_count) {
  return node_count * (node_count + kMoreReceivers);
}

std::size_t links_at(std::uint32_t node_count) {
  return tallies_at(node_count) + tally_count(node_count) * sizeof(LinkTallySlot);
}

std::size_t tally_index(std::size_t node_count, std::uint32_t sender, std::int32_t receiver) {
  const std::size_t column = receiver >= 0          ? static_cast<std::size_t>(receiver)
                             : receiver == kToGroup ? node_count
                                                    : node_count + 1;
  return sender * (node_count + kMoreReceivers) + column;
}

// A LinkReading in one word.
constexpr unsigned kLevelAt = 48;
constexpr unsigned kRateAt = 32;
constexpr float kLevelsPerDecibel = 100.0F;
constexpr float kHighestLevel = 32'767.0F;

std::uint64_t word_of(const LinkReading& reading) {
  const auto level = static_cast<std::int16_t>(std::lround(
      std::clamp(reading.received_dbm * kLevelsPerDecibel, -kHighestLevel, kHighestLevel)));
  const std::uint64_t rate = reading.rate_kbps / kRateUnit_kbps;
  return static_cast<std::uint64_t>(static_cast<std::uint16_t>(level)) << kLevelAt |
         rate << kRateAt | reading.sim_time_ms;
}

LinkReading reading_of(std::uint64_t word) {
  return {.received_dbm =
              static_cast<float>(static_cast<std::int16_t>(word >> kLevelAt)) / kLevelsPerDecibel,
          .rate_kbps = static_cast<std::uint32_t>(word >> kRateAt & 0xffffU) * kRateUnit_kbps,
          .sim_time_ms = static_cast<std::uint32_t>(word)};
}

}  // namespace

std::size_t RadioMemoryWriter::byte_size(std::uint32_t node_count) {
  return links_at(node_count) +
         static_cast<std::size_t>(node_count) * node_count * sizeof(std::atomic<std::uint64_t>);
}

RadioMemoryWriter::RadioMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count)
    : layout_{new (memory.data()) RadioMemoryLayout{}},
      slots_{reinterpret_cast<RadioMemoryLayout::Slot*>(memory.data() + kSlotsAt), node_count},
      tallies_{reinterpret_cast<LinkTallySlot*>(memory.data() + tallies_at(node_count)),
               tally_count(node_count)},
      links_{reinterpret_cast<std::atomic<std::uint64_t>*>(memory.data() + links_at(node_count)),
             static_cast<std::size_t>(node_count) * node_count} {
  write_header(memory, {.magic = RadioMemoryLayout::kMagic,
                        .version = RadioMemoryLayout::kVersion,
                        .node_count = node_count,
                        .byte_size = byte_size(node_count)});
  std::uninitialized_value_construct(slots_.begin(), slots_.end());
  std::uninitialized_value_construct(tallies_.begin(), tallies_.end());
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
  links_[static_cast<std::size_t>(receiver) * slots_.size() + sender].store(
      word_of(reading), std::memory_order_relaxed);
}

LinkTallySlot& RadioMemoryWriter::link_tally(std::uint32_t sender, std::int32_t receiver) noexcept {
  return tallies_[tally_index(slots_.size(), sender, receiver)];
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
  tallies_ = {reinterpret_cast<const LinkTallySlot*>(memory.data() + tallies_at(count)),
              tally_count(count)};
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
  return reading_of(word);
}

LinkTally RadioMemoryReader::link_tally(std::uint32_t sender,
                                        std::int32_t receiver) const noexcept {
  return tallies_[tally_index(slots_.size(), sender, receiver)].load();
}

std::uint64_t RadioMemoryReader::heartbeat() const noexcept {
  return layout_->progress.heartbeat.load(std::memory_order_acquire);
}

std::int64_t RadioMemoryReader::sim_time_ns() const noexcept {
  return layout_->progress.sim_time_ns.load(std::memory_order_relaxed);
}

}  // namespace cuscus::shm
