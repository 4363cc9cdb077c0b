#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/random/counter_stream.h"

namespace cuscus::world {

/// Standard deviations of the white noise of each reading, per axis.
struct ImuNoise {
  double gyro_radps;
  double accelerometer_mps2;
};

struct ImuSample {
  Eigen::Vector3d angular_rate_B_radps;
  Eigen::Vector3d specific_force_B_mps2;  ///< +g upwards at rest.
};

/// Gyroscope and accelerometer of one node, at its centre of mass, axes FLU: truth plus white noise
/// that is a function of (seed, node, reading). No bias, scale error, range or bandwidth.
class Imu {
 public:
  Imu(std::uint64_t seed, std::uint32_t node, const ImuNoise& noise);

  /// Reading number `reading` of the run, when the truth is `truth`.
  [[nodiscard]] ImuSample sample(const ImuSample& truth, std::uint64_t reading) const;

 private:
  random::CounterStream gyro_;
  random::CounterStream accelerometer_;
  ImuNoise noise_;
};

}  // namespace cuscus::world
