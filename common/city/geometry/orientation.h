#pragma once

#include <Eigen/Core>
#include <cmath>

namespace cuscus::city {

/// orientation() without the filter: for points that are all but in line.
[[nodiscard]] double exact_orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                       const Eigen::Vector2d& c);

/// Twice the area of the triangle a, b, c: positive where they turn left, 0 where they are in line.
/// The sign is exact; the value is rounded.
///
/// Source of the filter's bound and of exact sums by expansions: J. R. Shewchuk, "Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997, section 4.2.
[[nodiscard]] inline double orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                        const Eigen::Vector2d& c) {
  constexpr double kRounding = 0x1p-53;
  constexpr double kBound = (3.0 + 16.0 * kRounding) * kRounding;
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double area = left - right;
  return std::abs(area) > kBound * (std::abs(left) + std::abs(right)) ? area
                                                                      : exact_orientation(a, b, c);
}

}  // namespace cuscus::city
