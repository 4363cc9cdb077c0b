#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/seqlock.h"

namespace cuscus::shm {

/// What a radio knows of another one, from the frames that it has decoded.
struct NeighbourReading {
  std::int64_t sim_time_ns;  ///< When the latest was over.
  std::uint64_t frames;      ///< How many there were; 0: none.
  float received_dbm;        ///< Of the latest.
  float mean_dbm;            ///< Weighs the latest by 1/8 and the mean before it by 7/8.
  float snr_db;              ///< Of the latest, over thermal noise and noise figure.
  std::uint32_t rate_kbps;   ///< Of the latest.
};

/// What the radio of one node tells its program: written by netsim, read by that node's agent,
/// which sees nobody else's. 40 B per node of the run: 4 kB for 100 nodes, and for all of them
/// together 0.4 MB; 40 MB for 1000.
struct RadioReadingsLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSRDNGS");
  static constexpr std::uint32_t kVersion = 1;

  Header header;
  float threshold_dbm;  ///< Nothing weaker is received; see RadioReadingsWriter.
  float reserved;
  // node_count Seqlock<NeighbourReading> follow.
};

class RadioReadingsWriter {
 public:
  [[nodiscard]] static std::size_t byte_size(std::uint32_t node_count);
  /// `threshold_dbm` is the least level at which a frame is received when nobody else sends.
  RadioReadingsWriter(std::span<std::byte> memory, std::uint32_t node_count, float threshold_dbm);

  /// A frame of `sender` was decoded.
  void heard(std::uint32_t sender, std::int64_t sim_time_ns, float received_dbm, float snr_db,
             std::uint32_t rate_kbps) noexcept;

 private:
  std::span<Seqlock<NeighbourReading>> slots_;
};

class RadioReadingsReader {
 public:
  /// @throws LayoutError when `memory` holds no radio readings.
  explicit RadioReadingsReader(std::span<const std::byte> memory);

  [[nodiscard]] std::uint32_t node_count() const noexcept;
  [[nodiscard]] float threshold_dbm() const noexcept { return layout_->threshold_dbm; }
  /// Nothing when `sender` was never heard. `sender` < node_count().
  [[nodiscard]] std::optional<NeighbourReading> neighbour(std::uint32_t sender) const noexcept;

 private:
  const RadioReadingsLayout* layout_;
  std::span<const Seqlock<NeighbourReading>> slots_;
};

}  // namespace cuscus::shm
