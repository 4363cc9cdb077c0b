#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include "common/units/sim_time.h"

namespace cuscus::gcs {

/// What a UAV said of itself, checked.
struct TelemetrySample {
  std::uint32_t node;
  std::uint32_t sequence;
  SimTime at;  ///< When it was true.
  std::array<double, 3> p_WB_m;
  std::array<double, 3> v_WB_W_mps;
  double yaw_rad;
  std::string state;  ///< 1 to 24 of a-z, 0-9 and '-'.
  std::uint32_t neighbours_heard;
};

/// Why a datagram on the telemetry port is ignored.
enum class TelemetryFault : std::uint8_t {
  kMalformed,  ///< Not a Telemetry message, or too long for one.
  kUnknownNode,
  kNotFinite,
  kOutOfRange,  ///< Beyond kFarthest_m or kFastest_mps, or a yaw that is no angle.
  kBadState,
  kFromTheFuture,
};
inline constexpr std::size_t kTelemetryFaults = 6;

/// The longest datagram that is looked at [B]; our own agents send about 80.
inline constexpr std::size_t kLongestTelemetry_bytes = 512;
inline constexpr double kFarthest_m = 1e6;
inline constexpr double kFastest_mps = 1e3;

/// Reads one datagram; anybody may have sent it. That `node` is one of the fleet is for the caller
/// to check.
[[nodiscard]] std::variant<TelemetrySample, TelemetryFault> decode_telemetry(
    std::span<const std::byte> datagram, SimTime now);

}  // namespace cuscus::gcs
