#include "common/city/generate/convex_cell.h"

#include <algorithm>
#include <limits>

namespace cuscus::city::generate {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

const CellCorner& after(const ConvexCell& cell, std::size_t i) {
  return cell[(i + 1) % cell.size()];
}

/// What lies on the cell's side of its edge i.
HalfPlane inner_side(const ConvexCell& cell, std::size_t i) {
  const Eigen::Vector2d along = (after(cell, i).p - cell[i].p).normalized();
  const Eigen::Vector2d outward{along.y(), -along.x()};
  return {outward, outward.dot(cell[i].p)};
}

}  // namespace

ConvexCell clip(const ConvexCell& cell, const HalfPlane& plane, int across) {
  ConvexCell kept;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const CellCorner& a = cell[i];
    const Eigen::Vector2d& b = after(cell, i).p;
    const double beyond_a = plane.normal.dot(a.p) - plane.offset_m;
    const double beyond_b = plane.normal.dot(b) - plane.offset_m;
    if (beyond_a <= 0.0) {
      kept.push_back(a);
    }
    if ((beyond_a <= 0.0) != (beyond_b <= 0.0)) {
      const Eigen::Vector2d crossing = a.p + (b - a.p) * (beyond_a / (beyond_a - beyond_b));
      kept.push_back({crossing, beyond_a <= 0.0 ? across : a.across});
    }
  }
  return kept.size() < 3 ? ConvexCell{} : kept;
}

ConvexCell inset(const ConvexCell& cell, const std::function<double(int)>& margin_m) {
  ConvexCell inner = cell;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    HalfPlane side = inner_side(cell, i);
    side.offset_m -= margin_m(cell[i].across);
    inner = clip(inner, side, cell[i].across);
  }
  return inner;
}

ConvexCell inset(const ConvexCell& cell, double margin_m) {
  return inset(cell, [&](int) { return margin_m; });
}

ConvexCell without_short_edges(ConvexCell cell, double shortest_m) {
  for (std::size_t i = 0; i < cell.size() && cell.size() > 2;) {
    if ((after(cell, i).p - cell[i].p).norm() < shortest_m) {
      cell.erase(cell.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return cell.size() < 3 ? ConvexCell{} : cell;
}

double area_m2(const ConvexCell& cell) {
  double twice = 0.0;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    twice += cross(cell[i].p, after(cell, i).p);
  }
  return twice / 2.0;
}

Eigen::Vector2d centroid(const ConvexCell& cell) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const Eigen::Vector2d& a = cell[i].p;
    const Eigen::Vector2d& b = after(cell, i).p;
    sum += (a + b) * cross(a, b);
  }
  return sum / (6.0 * area_m2(cell));
}

bool contains(const ConvexCell& cell, const Eigen::Vector2d& point) {
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (cross(after(cell, i).p - cell[i].p, point - cell[i].p) < 0.0) {
      return false;
    }
  }
  return !cell.empty();
}

Eigen::Vector2d long_direction(const ConvexCell& cell) {
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const Eigen::Vector2d edge = after(cell, i).p - cell[i].p;
    if (edge.squaredNorm() > longest.squaredNorm()) {
      longest = edge;
    }
  }
  return longest.normalized();
}

double narrowest_m(const ConvexCell& cell) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const HalfPlane side = inner_side(cell, i);
    double depth = 0.0;
    for (const CellCorner& corner : cell) {
      depth = std::max(depth, side.offset_m - side.normal.dot(corner.p));
    }
    least = std::min(least, depth);
  }
  return cell.empty() ? 0.0 : least;
}

Ring ring_of(const ConvexCell& cell) {
  Ring ring;
  ring.reserve(cell.size());
  for (const CellCorner& corner : cell) {
    ring.push_back(corner.p);
  }
  return ring;
}

ConvexCell rectangle(const Eigen::Vector2d& south_west, const Eigen::Vector2d& north_east) {
  return {{south_west, -1},
          {{north_east.x(), south_west.y()}, -2},
          {north_east, -3},
          {{south_west.x(), north_east.y()}, -4}};
}

}  // namespace cuscus::city::generate
