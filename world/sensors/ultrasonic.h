#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/random/counter_stream.h"
#include "world/dynamics/plant.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

struct UltrasonicParameters {
  Eigen::Vector3d axis_B{-Eigen::Vector3d::UnitZ()};  ///< Where it points; of length 1.
  double half_angle_rad{0.2617993877991494};          ///< Of its cone: 15 degrees.
  double range_m{6.0};
  double noise_m{0.01};  ///< Standard deviation per reading.
};

/// An ultrasonic rangefinder: the distance to the nearest surface in its cone, as far as it
/// reaches, plus white noise that is a function of (seed, node, reading).
///
/// Exact where the nearest surface of all is in the cone, as it is over level ground. Otherwise the
/// nearest hit of a bundle of rays: the axis, and 8, 16 and 24 rays at a third, two thirds and the
/// whole of the half angle. Of a plane whose nearest point is outside of the cone they find the
/// distance to 0.2 % up to 30° and a half angle of 15° (tested).
///
/// Source: FL-AIR's simulated X4 has one that looks down at 50 Hz with a range of 6 m, 4 cm off the
/// centre along z. Here it is 4 cm above the vehicle's position, so that it measures 4 cm on the
/// ground. The cone's width, which FL-AIR's parameters do not tell, and the noise are ours. No echo
/// is lost to a surface's slope or kind, and other vehicles are not heard.
class Ultrasonic {
 public:
  Ultrasonic(std::uint64_t seed, std::uint32_t node, const UltrasonicParameters& parameters);

  /// Reading number `reading` of the run at `body`: the distance [m], 0 or more; nothing when
  /// nothing is in range.
  [[nodiscard]] std::optional<double> sample(const Surroundings& surroundings,
                                             const RigidBodyState& body,
                                             std::uint64_t reading) const;

 private:
  [[nodiscard]] std::optional<double> distance_m(const Surroundings& surroundings,
                                                 const RigidBodyState& body) const;

  random::CounterStream noise_;
  UltrasonicParameters parameters_;
  std::vector<Eigen::Vector3d> rays_B_;
};

}  // namespace cuscus::world
