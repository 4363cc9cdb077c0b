#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "uav-agent/flight/estimator.h"
#include "uav-agent/missions/neighbour_table.h"

namespace cuscus::air {

/// The longest beacon that an agent sends or takes [B].
inline constexpr std::size_t kBeaconBytesMax = 100;

/// What a beacon says.
struct Beacon {
  missions::NeighbourReport report;
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

/// One UDP payload (proto::Beacon), at most kBeaconBytesMax.
[[nodiscard]] std::string encoded(const Beacon& beacon);

/// Reads a UDP payload; nothing when it is not a beacon. proto3 fields may be absent, so that many
/// strings of random bytes parse: a beacon is told from them by its attitude, which must have unit
/// length. The other numbers are not judged here: NeighbourTable does that.
[[nodiscard]] std::optional<Beacon> decoded(std::span<const std::byte> payload);

/// What a UAV tells the ground station.
struct TelemetryReport {
  std::uint32_t node = 0;
  std::uint32_t sequence = 0;
  flight::VehicleEstimate estimate;
  double yaw_rad = 0.0;
  std::string_view state;
  std::uint32_t neighbours_heard = 0;
};

/// One UDP payload (proto::Telemetry).
[[nodiscard]] std::string encoded(const TelemetryReport& telemetry);

}  // namespace cuscus::air
