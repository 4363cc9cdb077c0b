#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/city/geometry/box_tree.h"
#include "common/city/geometry/segment.h"

namespace cuscus::city {

/// All that is at most a radius away from a straight line between two points.
struct Capsule {
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};
  double radius_m{0.0};

  [[nodiscard]] Box box() const;
  /// The point of its axis that is nearest.
  [[nodiscard]] Eigen::Vector3d on_axis(const Eigen::Vector3d& p) const;
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p) const {
    return (p - on_axis(p)).norm() - radius_m;
  }
  /// From the axis to a point, of length 1; upwards on the axis.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const;
  /// Which part of the line start + t way is inside.
  [[nodiscard]] std::optional<Interval> inside(const Eigen::Vector3d& start,
                                               const Eigen::Vector3d& way) const;
};

/// A tree as a solid.
struct TreeShape {
  explicit TreeShape(const Tree& tree);

  Capsule crown;
  Capsule trunk;
};

}  // namespace cuscus::city
