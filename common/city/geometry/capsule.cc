#include "common/city/geometry/capsule.h"

#include <algorithm>
#include <cmath>

namespace cuscus::city {
namespace {

/// Where |p + t w|² - r² is below 0; false if nowhere.
bool within_radius(const Eigen::Vector3d& p, const Eigen::Vector3d& w, double radius_m,
                   Interval& part) {
  const double w2 = w.squaredNorm();
  if (w2 == 0.0) {
    return false;
  }
  const double middle = -p.dot(w) / w2;
  // From the nearest point, so that little is lost where p is far away.
  const double half2 = (radius_m * radius_m - (p + middle * w).squaredNorm()) / w2;
  if (!(half2 > 0.0)) {
    return false;
  }
  part = {.begin = middle - std::sqrt(half2), .end = middle + std::sqrt(half2)};
  return true;
}

void widen(std::optional<Interval>& whole, const Interval& part) {
  whole = whole ? Interval{.begin = std::min(whole->begin, part.begin),
                           .end = std::max(whole->end, part.end)}
                : part;
}

}  // namespace

Box Capsule::box() const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m);
  return {.low_m = from.cwiseMin(to) - reach, .high_m = from.cwiseMax(to) + reach};
}

Eigen::Vector3d Capsule::on_axis(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d axis = to - from;
  const double length2 = axis.squaredNorm();
  return length2 > 0.0 ? from + std::clamp((p - from).dot(axis) / length2, 0.0, 1.0) * axis : from;
}

Eigen::Vector3d Capsule::normal(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d away = p - on_axis(p);
  const double length = away.norm();
  return length > 0.0 ? Eigen::Vector3d{away / length} : Eigen::Vector3d::UnitZ();
}

std::optional<Interval> Capsule::inside(const Eigen::Vector3d& start,
                                        const Eigen::Vector3d& way) const {
  // It is convex: what is in its two balls and its cylinder is one interval.
  std::optional<Interval> whole;
  Interval part;
  for (const Eigen::Vector3d& centre : {from, to}) {
    if (within_radius(start - centre, way, radius_m, part)) {
      widen(whole, part);
    }
  }
  const Eigen::Vector3d axis = to - from;
  const double length = axis.norm();
  if (length == 0.0) {
    return whole;
  }
  const Eigen::Vector3d u = axis / length;
  const double start_along = (start - from).dot(u);
  const double way_along = way.dot(u);
  const Eigen::Vector3d start_across = (start - from) - start_along * u;
  const Eigen::Vector3d way_across = way - way_along * u;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // A way along the axis is in the cylinder for ever, or not at all.
  if (way_across.squaredNorm() <= 1e-24 * way.squaredNorm()) {
    if (start_across.norm() >= radius_m) {
      return whole;
    }
    part = {.begin = -kInfinity, .end = kInfinity};
  } else if (!within_radius(start_across, way_across, radius_m, part)) {
    return whole;
  }
  if (way_along == 0.0) {
    if (start_along >= 0.0 && start_along <= length) {
      widen(whole, part);
    }
    return whole;
  }
  const double at_from = -start_along / way_along;
  const double at_to = (length - start_along) / way_along;
  part.begin = std::max(part.begin, std::min(at_from, at_to));
  part.end = std::min(part.end, std::max(at_from, at_to));
  if (part.begin < part.end) {
    widen(whole, part);
  }
  return whole;
}

TreeShape::TreeShape(const Tree& tree) {
  const double radius_m = tree.crown_radius_m;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double highest_m = tree.height_m - radius_m;
  const double lowest_m = std::min(tree.height_m / 3.0 + radius_m, highest_m);
  crown = {.from = tree.foot_m + lowest_m * up,
           .to = tree.foot_m + highest_m * up,
           .radius_m = radius_m};
  trunk = {.from = tree.foot_m, .to = crown.from, .radius_m = 0.1 * radius_m};
}

}  // namespace cuscus::city
