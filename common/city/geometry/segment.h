#pragma once

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>

#include "common/city/geometry/city_geometry.h"

namespace cuscus::city {

/// A segment as all decisions see it: from its lesser end, by east, north, up, so that they do not
/// depend on which way it is asked for.
struct Segment {
  Segment(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB);

  [[nodiscard]] Eigen::Vector3d at(double t) const { return a + t * (b - a); }
  /// A part of it as the caller sees it.
  [[nodiscard]] Interval asked_for(const Interval& part) const {
    return reversed ? Interval{.begin = 1.0 - part.end, .end = 1.0 - part.begin} : part;
  }
  /// Seen from above it is a point.
  [[nodiscard]] bool upright() const { return a.x() == b.x() && a.y() == b.y(); }

  Eigen::Vector3d a;
  Eigen::Vector3d b;
  bool reversed;
};

/// Parts of a segment's line, also beyond its ends.
using Intervals = boost::container::small_vector<Interval, 16>;

/// Sorts them, and makes one of those that overlap or are at most `seam` apart.
void unite(Intervals& parts, double seam);
/// Cuts to [0, 1]: what only touches that goes.
void cut_to_segment(Intervals& parts);

}  // namespace cuscus::city
