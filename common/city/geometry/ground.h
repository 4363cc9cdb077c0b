#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// The ground: a plane at 0, or a terrain, bilinear between its heights, and beyond its rim as high
/// as that.
class Ground final {
 public:
  explicit Ground(const std::optional<Terrain>& terrain) : terrain_{terrain} {}

  [[nodiscard]] double height_m(const Eigen::Vector2d& p) const;
  /// Of length 1, upwards; that of one of the neighbours where two cells meet.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector2d& p) const;
  [[nodiscard]] double lowest_m() const;

  /// Where the segment from a to b first goes below the ground; 0 if it begins there.
  [[nodiscard]] std::optional<double> hit(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// The distance along the normal at the point's foot, negative below: exact for planes.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p) const;
  /// Where a ball that moves from a to b first touches it and moves deeper. By distance_m(), at
  /// four places or more between any two lines of the grid and never later than its centre goes
  /// below.
  [[nodiscard]] std::optional<double> contact(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                              double radius_m) const;

 private:
  struct Cell {
    Eigen::Vector2d within;  ///< 0 to 1.
    double south_west, south_east, north_west, north_east;
  };
  [[nodiscard]] Cell cell_at(const Eigen::Vector2d& p) const;
  /// Where the segment goes over a line of the grid, in order, with 0 and 1.
  [[nodiscard]] std::vector<double> pieces(const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b) const;

  std::optional<Terrain> terrain_;
};

}  // namespace cuscus::city
