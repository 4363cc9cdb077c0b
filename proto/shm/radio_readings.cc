#include "proto/shm/radio_readings.h"

#include <memory>
#include <new>

namespace cuscus::shm {
namespace {

using Slot = Seqlock<NeighbourReading>;

/// As avg_signal of a station in Linux (mac80211, sta_info.h).
constexpr float kWeight = 1.0F / 8.0F;

}  // namespace

std::size_t RadioReadingsWriter::byte_size(std::uint32_t node_count) {
  return sizeof(RadioReadingsLayout) + node_count * sizeof(Slot);
}

RadioReadingsWriter::RadioReadingsWriter(std::span<std::byte> memory, std::uint32_t node_count,
                                         float threshold_dbm)
    : slots_{reinterpret_cast<Slot*>(memory.data() + sizeof(RadioReadingsLayout)), node_count} {
  new (memory.data())
      RadioReadingsLayout{.header = {}, .threshold_dbm = threshold_dbm, .reserved = 0};
  write_header(memory, {.magic = RadioReadingsLayout::kMagic,
                        .version = RadioReadingsLayout::kVersion,
                        .node_count = node_count,
                        .byte_size = byte_size(node_count)});
  std::uninitialized_value_construct(slots_.begin(), slots_.end());
}

void RadioReadingsWriter::heard(std::uint32_t sender, std::int64_t sim_time_ns, float received_dbm,
                                float snr_db, std::uint32_t rate_kbps) noexcept {
  NeighbourReading reading = slots_[sender].load().value_or(NeighbourReading{});
  reading.mean_dbm = reading.frames == 0
                         ? received_dbm
                         : reading.mean_dbm + kWeight * (received_dbm - reading.mean_dbm);
  ++reading.frames;
  reading.sim_time_ns = sim_time_ns;
  reading.received_dbm = received_dbm;
  reading.snr_db = snr_db;
  reading.rate_kbps = rate_kbps;
  slots_[sender].store(reading);
}

RadioReadingsReader::RadioReadingsReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const RadioReadingsLayout*>(memory.data())} {
  const Header header =
      checked_header(memory, RadioReadingsLayout::kMagic, RadioReadingsLayout::kVersion);
  if (RadioReadingsWriter::byte_size(header.node_count) != memory.size()) {
    throw LayoutError{"radio readings: their size does not fit their number of nodes"};
  }
  slots_ = {reinterpret_cast<const Slot*>(memory.data() + sizeof(RadioReadingsLayout)),
            header.node_count};
}

std::uint32_t RadioReadingsReader::node_count() const noexcept {
  return static_cast<std::uint32_t>(slots_.size());
}

std::optional<NeighbourReading> RadioReadingsReader::neighbour(
    std::uint32_t sender) const noexcept {
  const auto reading = slots_[sender].load();
  return reading && reading->frames > 0 ? reading : std::nullopt;
}

}  // namespace cuscus::shm
