#include "common/city/generate/lots.h"

#include <algorithm>

namespace cuscus::city::generate {
namespace {

constexpr int kTries = 8;
constexpr double kSkew = 0.12;           // of a dividing line, about 7 deg
constexpr double kShortestSide_m = 1.0;  // shorter ones are no walls
constexpr double kOnLine_m = 1e-6;       // rounding errors are near 1e-13
constexpr double kApart_m = 1e-3;        // corners nearer than that are one, once snapped
constexpr double kNarrowCourtyard_m = 4.0;

double shortest_side_m(const ConvexCell& cell) {
  double shortest = (cell.front().p - cell.back().p).norm();
  for (std::size_t i = 1; i < cell.size(); ++i) {
    shortest = std::min(shortest, (cell[i].p - cell[i - 1].p).norm());
  }
  return shortest;
}

bool is_a_lot(const ConvexCell& cell, const LotSizes& sizes) {
  return !cell.empty() && area_m2(cell) >= sizes.smallest_m2 &&
         narrowest_m(cell) >= sizes.narrowest_m && shortest_side_m(cell) >= kShortestSide_m;
}

/// A line across the cell's longest side, somewhere in its middle third.
HalfPlane dividing_line(const ConvexCell& cell, Dice& dice) {
  const Eigen::Vector2d along = long_direction(cell);
  const Eigen::Vector2d across{-along.y(), along.x()};
  double least = along.dot(cell.front().p);
  double most = least;
  for (const CellCorner& corner : cell) {
    least = std::min(least, along.dot(corner.p));
    most = std::max(most, along.dot(corner.p));
  }
  const Eigen::Vector2d middle = centroid(cell);
  const double at = least + (most - least) * dice.uniform(0.36, 0.64);
  const Eigen::Vector2d through = middle + along * (at - along.dot(middle));
  const Eigen::Vector2d normal = (along + across * dice.uniform(-kSkew, kSkew)).normalized();
  return {normal, normal.dot(through)};
}

void divide(const ConvexCell& cell, const LotSizes& sizes, Dice& dice,
            std::vector<ConvexCell>& lots) {
  for (int attempt = 0; area_m2(cell) > sizes.largest_m2 && attempt < kTries; ++attempt) {
    const HalfPlane line = dividing_line(cell, dice);
    const ConvexCell one = clip(cell, line, 0);
    const ConvexCell other = clip(cell, line.opposite(), 0);
    if (is_a_lot(one, sizes) && is_a_lot(other, sizes)) {
      divide(one, sizes, dice, lots);
      divide(other, sizes, dice, lots);
      return;
    }
  }
  lots.push_back(cell);
}

/// Whether a point is on the side from a to b, and apart from both.
bool lies_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  const double at = along.dot(p - a);
  const double beside = along.x() * (p - a).y() - along.y() * (p - a).x();
  return std::abs(beside) < kOnLine_m && at > kApart_m && at < length - kApart_m;
}

}  // namespace

std::vector<ConvexCell> divided(const ConvexCell& block, const LotSizes& sizes, Dice& dice) {
  std::vector<ConvexCell> lots;
  divide(block, sizes, dice, lots);
  return lots;
}

std::vector<Ring> outlines_with_common_corners(const std::vector<ConvexCell>& lots) {
  std::vector<Ring> outlines;
  for (const ConvexCell& lot : lots) {
    Ring outline;
    for (std::size_t i = 0; i < lot.size(); ++i) {
      const Eigen::Vector2d& a = lot[i].p;
      const Eigen::Vector2d& b = lot[(i + 1) % lot.size()].p;
      Ring between;
      for (const ConvexCell& other : lots) {
        for (const CellCorner& corner : other) {
          if (lies_between(a, b, corner.p)) {
            between.push_back(corner.p);
          }
        }
      }
      std::sort(between.begin(), between.end(),
                [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
                  return (p - a).squaredNorm() < (q - a).squaredNorm();
                });
      outline.push_back(a);
      outline.insert(outline.end(), between.begin(), between.end());
    }
    outlines.push_back(snapped_ring(outline));
  }
  return outlines;
}

Ring snapped_ring(const Ring& ring) {
  Ring result;
  for (const Eigen::Vector2d& corner : ring) {
    const Eigen::Vector2d p = snapped(corner);
    if (result.empty() || p != result.back()) {
      result.push_back(p);
    }
  }
  while (result.size() > 1 && result.front() == result.back()) {
    result.pop_back();
  }
  return result;
}

Ring courtyard_in(const ConvexCell& lot, double depth_m, double smallest_m2) {
  const ConvexCell inner = without_short_edges(inset(lot, depth_m), kShortestSide_m);
  if (inner.empty() || area_m2(inner) < smallest_m2 || narrowest_m(inner) < kNarrowCourtyard_m) {
    return {};
  }
  Ring ring = snapped_ring(ring_of(inner));
  std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace cuscus::city::generate
