#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/units/sim_time.h"
#include "ground-station/core/sequence_tally.h"
#include "ground-station/core/snapshot.h"
#include "ground-station/core/telemetry.h"
#include "proto/configuration.pb.h"

namespace cuscus::gcs {

/// What the ground station knows of the fleet: what the UAVs said over the air, beside what is
/// true, so that an operator sees both what a real one would know and what it would miss.
class FleetPicture {
 public:
  /// More linked pairs than this would cost more to draw than they tell.
  static constexpr std::size_t kMostLinks = 2000;

  /// @throws std::invalid_argument when two nodes have one number.
  explicit FleetPicture(const proto::GroundStationConfiguration& configuration);

  /// Takes in one datagram of the telemetry port. False when it was garbage, which is counted.
  bool receive(std::span<const std::byte> datagram, SimTime now);

  [[nodiscard]] Snapshot snapshot(const Observation& observation, SimTime now,
                                  RunState state) const;

  /// Good telemetry, duplicates included.
  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  [[nodiscard]] std::uint64_t rejected() const noexcept;
  [[nodiscard]] std::uint64_t rejected(TelemetryFault fault) const noexcept {
    return rejected_[static_cast<std::size_t>(fault)];
  }

 private:
  struct Vehicle {
    std::optional<TelemetrySample> latest;
    SequenceTally tally;
  };

  bool reject(TelemetryFault fault) noexcept;

  proto::GroundStationConfiguration configuration_;
  std::map<std::uint32_t, Vehicle> vehicles_;
  std::uint64_t received_{0};
  std::array<std::uint64_t, kTelemetryFaults> rejected_{};
};

}  // namespace cuscus::gcs
