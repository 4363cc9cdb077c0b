#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city::generate {

/// A corner of a cell, and the number of what lies across the edge that begins there.
struct CellCorner {
  Eigen::Vector2d p{Eigen::Vector2d::Zero()};
  int across{0};
};

/// A convex polygon, counter-clockwise. Empty, or three corners and more.
using ConvexCell = std::vector<CellCorner>;

/// The points p with normal . p <= offset_m; the normal has length 1.
struct HalfPlane {
  Eigen::Vector2d normal{Eigen::Vector2d::Zero()};
  double offset_m{0.0};

  [[nodiscard]] HalfPlane opposite() const { return {-normal, -offset_m}; }
};

/// The part of a cell in a half plane. The new edge has `across` on its other side.
[[nodiscard]] ConvexCell clip(const ConvexCell& cell, const HalfPlane& plane, int across);

/// The part of a cell that is at least margin_m(across) away from each edge's line.
[[nodiscard]] ConvexCell inset(const ConvexCell& cell, const std::function<double(int)>& margin_m);
[[nodiscard]] ConvexCell inset(const ConvexCell& cell, double margin_m);

/// A cell within `cell`, without corners that are nearer to the next one than `shortest_m`.
[[nodiscard]] ConvexCell without_short_edges(ConvexCell cell, double shortest_m);

[[nodiscard]] double area_m2(const ConvexCell& cell);
[[nodiscard]] Eigen::Vector2d centroid(const ConvexCell& cell);
[[nodiscard]] bool contains(const ConvexCell& cell, const Eigen::Vector2d& point);
/// Direction of the longest edge, of length 1.
[[nodiscard]] Eigen::Vector2d long_direction(const ConvexCell& cell);
/// Least distance between two parallels that have the cell between them.
[[nodiscard]] double narrowest_m(const ConvexCell& cell);
[[nodiscard]] Ring ring_of(const ConvexCell& cell);
/// Upright, with `across` -1 in the south, -2 in the east, -3 in the north and -4 in the west.
[[nodiscard]] ConvexCell rectangle(const Eigen::Vector2d& south_west,
                                   const Eigen::Vector2d& north_east);

}  // namespace cuscus::city::generate
