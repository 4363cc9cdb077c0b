#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/random/counter_stream.h"
#include "world/dynamics/plant.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

struct LidarParameters {
  std::uint32_t rays{360};                ///< Of one row.
  double field_rad{6.283185307179586};    ///< Azimuths that a row covers, around ahead.
  std::vector<double> elevations_rad{0};  ///< Of the rows; one: a 2-D lidar.
  double range_m{30.0};
  double noise_m{0.02};  ///< Standard deviation per ray.
};

/// Azimuth of ray k of a row, from ahead counter-clockwise: from −field/2 on, evenly; a whole
/// circle's last ray is one step before its first, any other field's at +field/2.
[[nodiscard]] double lidar_azimuth_rad(const LidarParameters& parameters, std::uint32_t k);

/// A lidar: the distance to the first surface on each ray, plus white noise that is a function of
/// (seed, node, reading, ray). It is 10 cm above the vehicle's position and turns with the body;
/// all rays of a reading are of one instant. No intensity, no beam width; other vehicles are not
/// seen.
class Lidar {
 public:
  Lidar(std::uint64_t seed, std::uint32_t node, const LidarParameters& parameters);

  [[nodiscard]] std::size_t size() const { return rays_B_.size(); }

  /// Reading number `reading` of the run at `body` [m], row by row, 0 or more; infinite: nothing in
  /// range. `ranges_m` has size().
  void sample(const Surroundings& surroundings, const RigidBodyState& body, std::uint64_t reading,
              std::span<float> ranges_m) const;

 private:
  random::CounterStream noise_;
  double range_m_;
  double noise_m_;
  std::vector<Eigen::Vector3d> rays_B_;
};

}  // namespace cuscus::world
