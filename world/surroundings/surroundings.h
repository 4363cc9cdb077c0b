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

 private:
  const city::CityGeometry* city_{nullptr};
};

}  // namespace cuscus::world
