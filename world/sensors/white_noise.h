#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/random/counter_stream.h"

namespace cuscus::world {

/// What the world draws random numbers for; no other component uses these numbers.
struct NoisePurpose {
  static constexpr std::uint16_t kGyro = 0x5701;
  static constexpr std::uint16_t kAccelerometer = 0x5702;
  static constexpr std::uint16_t kMotionCapturePosition = 0x5703;
  static constexpr std::uint16_t kMotionCaptureAttitude = 0x5704;
  static constexpr std::uint16_t kUltrasonic = 0x5705;
  static constexpr std::uint16_t kLidar = 0x5706;
  static constexpr std::uint16_t kGnssDrift = 0x5707;
  static constexpr std::uint16_t kGnssRange = 0x5708;
  static constexpr std::uint16_t kGnssRangeRate = 0x5709;
};

/// Three independent standard normals: number `reading` of `stream`.
[[nodiscard]] inline Eigen::Vector3d normal_vector(const random::CounterStream& stream,
                                                   std::uint64_t reading) {
  return {stream.normal(3 * reading), stream.normal(3 * reading + 1),
          stream.normal(3 * reading + 2)};
}

}  // namespace cuscus::world
