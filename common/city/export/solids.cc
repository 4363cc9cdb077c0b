#include "common/city/export/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/city/export/triangulate.h"

namespace cuscus::city {
namespace {

constexpr double kTrunkSide_m = 0.3;
constexpr std::uint32_t kCrownSides = 6;

Ring square_around(const Eigen::Vector2d& middle, double side_m) {
  const double half_m = side_m / 2.0;
  return {middle + Eigen::Vector2d{-half_m, -half_m}, middle + Eigen::Vector2d{half_m, -half_m},
          middle + Eigen::Vector2d{half_m, half_m}, middle + Eigen::Vector2d{-half_m, half_m}};
}

}  // namespace

void SolidMesh::add_prism(const Footprint& footprint, double bottom_m, double top_m) {
  const FlatMesh roof = triangulated(footprint);
  const auto low = static_cast<std::uint32_t>(corners.size());
  const auto high = low + static_cast<std::uint32_t>(roof.corners.size());
  for (const double height_m : {bottom_m, top_m}) {
    for (const Eigen::Vector2d& corner : roof.corners) {
      corners.emplace_back(corner.x(), corner.y(), height_m);
    }
  }
  for (const Triangle& t : roof.triangles) {
    triangles.push_back({high + t[0], high + t[1], high + t[2]});
    triangles.push_back({low + t[2], low + t[1], low + t[0]});
  }
  std::uint32_t first = 0;
  const auto add_walls = [&](const Ring& ring) {
    const auto count = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = first + i;
      const std::uint32_t b = first + (i + 1) % count;
      triangles.push_back({low + a, low + b, high + b});
      triangles.push_back({low + a, high + b, high + a});
    }
    first += count;
  };
  add_walls(footprint.outer);
  std::for_each(footprint.courtyards.begin(), footprint.courtyards.end(), add_walls);
}

void SolidMesh::add_tree(const Tree& tree) {
  const double ground_m = tree.foot_m.z();
  const double crown_m = std::min(2.0 * tree.crown_radius_m, tree.height_m);
  const double crown_bottom_m = ground_m + tree.height_m - crown_m;
  const double crown_middle_m = crown_bottom_m + crown_m / 2.0;
  // Up to the middle of the crown, so that no gap shows.
  add_prism({.outer = square_around(tree.foot_m.head<2>(), kTrunkSide_m), .courtyards = {}},
            ground_m, crown_middle_m);
  const auto bottom = static_cast<std::uint32_t>(corners.size());
  corners.emplace_back(tree.foot_m.x(), tree.foot_m.y(), crown_bottom_m);
  corners.emplace_back(tree.foot_m.x(), tree.foot_m.y(), ground_m + tree.height_m);
  for (std::uint32_t i = 0; i < kCrownSides; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kCrownSides;
    corners.emplace_back(tree.foot_m.x() + tree.crown_radius_m * std::cos(angle_rad),
                         tree.foot_m.y() + tree.crown_radius_m * std::sin(angle_rad),
                         crown_middle_m);
  }
  for (std::uint32_t i = 0; i < kCrownSides; ++i) {
    const std::uint32_t a = bottom + 2 + i;
    const std::uint32_t b = bottom + 2 + (i + 1) % kCrownSides;
    triangles.push_back({bottom + 1, a, b});
    triangles.push_back({bottom, b, a});
  }
}

void SolidMesh::add_ground(const City& city) {
  const auto first = static_cast<std::uint32_t>(corners.size());
  if (!city.terrain || city.terrain->columns < 2 || city.terrain->rows < 2) {
    corners.emplace_back(city.south_west_m.x(), city.south_west_m.y(), 0.0);
    corners.emplace_back(city.north_east_m.x(), city.south_west_m.y(), 0.0);
    corners.emplace_back(city.north_east_m.x(), city.north_east_m.y(), 0.0);
    corners.emplace_back(city.south_west_m.x(), city.north_east_m.y(), 0.0);
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
    return;
  }
  const Terrain& terrain = *city.terrain;
  const auto columns = static_cast<std::uint32_t>(terrain.columns);
  const auto rows = static_cast<std::uint32_t>(terrain.rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const Eigen::Vector2d at =
          terrain.south_west_m + terrain.cell_m * Eigen::Vector2d{column, row};
      corners.emplace_back(at.x(), at.y(), terrain.height_m[row * terrain.columns + column]);
    }
  }
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = first + row * columns + column;
      triangles.push_back({a, a + 1, a + columns + 1});
      triangles.push_back({a, a + columns + 1, a + columns});
    }
  }
}

}  // namespace cuscus::city
