#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "netsim/air/air.h"
#include "proto/shm/radio_readings.h"

namespace cuscus::netsim {

/// Tells each node's program what its radio knows of the others: level, SNR and rate of the frames
/// that it decodes and whose header names the transmitter, which are data and RTS, to whomever they
/// are addressed.
class NeighbourReadings final : public AirMonitor {
 public:
  /// `readings` by node; nothing where no program asks.
  NeighbourReadings(std::vector<std::optional<shm::RadioReadingsWriter>> readings,
                    DecibelMilliwatt noise)
      : readings_{std::move(readings)}, noise_{noise} {}

  void transmitted(const Ppdu& /*ppdu*/) override {}
  void received(const Ppdu& ppdu, const Reception& reception) override;

 private:
  std::vector<std::optional<shm::RadioReadingsWriter>> readings_;
  DecibelMilliwatt noise_;
};

/// Thermal noise and noise figure in the standard's bandwidth.
[[nodiscard]] DecibelMilliwatt receiver_noise(const AirParameters& parameters);
/// The least level at which a receiver detects a frame when nobody else sends.
[[nodiscard]] DecibelMilliwatt reception_threshold(const AirParameters& parameters,
                                                   DecibelMilliwatt noise);

}  // namespace cuscus::netsim
