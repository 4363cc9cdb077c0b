#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/city/geometry/city_geometry.h"

namespace cuscus::world {

/// What vehicles can hit and sensors can see besides one another: a city, or the bare ground z = 0,
/// which answers as a city without anything in it would. Frame W, metres. Cheap to copy.
class Surroundings final {
 public:
  /// The bare ground.
  Surroundings() = default;
  /// `city`, which must outlive this; null: the bare ground.
  explicit Surroundings(const city::CityGeometry* city) : city_{city} {}

  [[nodiscard]] bool has_city() const { return city_ != nullptr; }

  /// As CityGeometry's queries of these names.
  [[nodiscard]] std::optional<city::Hit> first_hit(const Eigen::Vector3d& p_WO,
                                                   const Eigen::Vector3d& direction,
                                                   double range_m) const;
  [[nodiscard]] std::optional<city::Surface> nearest(const Eigen::Vector3d& p_W,
                                                     double radius_m) const;
  [[nodiscard]] std::optional<city::Contact> sweep(const Eigen::Vector3d& p_WP,
                                                   const Eigen::Vector3d& p_WQ,
                                                   double radius_m) const;

  /// The length of leaves that a ray from p_WO to the sky goes through; nothing when it does not
  /// get there, because a building or the ground is in its way. A city's curvature is none: no ray
  /// that points downwards gets there.
  [[nodiscard]] std::optional<double> foliage_to_sky_m(const Eigen::Vector3d& p_WO,
                                                       const Eigen::Vector3d& direction) const;

  /// Height of the ground.
  [[nodiscard]] double ground_m(const Eigen::Vector2d& p_W) const {
    return city_ != nullptr ? city_->ground_m(p_W) : 0.0;
  }

 private:
  const city::CityGeometry* city_{nullptr};
};

}  // namespace cuscus::world
