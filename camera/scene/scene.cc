#include "camera/scene/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "common/city/export/solids.h"

namespace cuscus::camera {
namespace {

using Colour = std::array<std::uint8_t, 4>;

constexpr double kTileSide_m = 150.0;
/// Beyond its rim the terrain goes on for this far.
constexpr double kBeyondRim_m = 20'000.0;
constexpr std::uint8_t kChecks = 255;
constexpr Colour kGroundColour{134, 128, 108, kChecks};
constexpr Colour kTreeColour{74, 112, 58, 0};
constexpr Colour kWoodColour{66, 100, 54, 0};
constexpr Colour kBodyColour{40, 44, 52, 0};
/// Flat roofs are covered with something else than the walls are made of.
constexpr double kRoofShare = 0.72;
constexpr double kUpwards = 0.9;

/// In the order of city::Material.
constexpr std::array<Colour, city::kMaterials> kWallColours{{{206, 192, 164, 0},
                                                             {188, 188, 184, 0},
                                                             {178, 104, 84, 0},
                                                             {128, 164, 188, 0},
                                                             {166, 172, 182, 0},
                                                             {160, 124, 84, 0}}};

struct Painted {
  std::array<Eigen::Vector3d, 3> corners_m;
  Colour colour;
};

Colour roof_of(const Colour& walls) {
  Colour roof = walls;
  std::transform(walls.begin(), walls.begin() + 3, roof.begin(),
                 [](std::uint8_t share) { return static_cast<std::uint8_t>(kRoofShare * share); });
  return roof;
}

Eigen::Vector3d normal_of(const std::array<Eigen::Vector3d, 3>& corners_m) {
  const Eigen::Vector3d across = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]);
  const double length = across.norm();
  return length > 0.0 ? Eigen::Vector3d{across / length} : Eigen::Vector3d::UnitZ();
}

void add_triangle(const Painted& triangle, std::vector<Vertex>& vertices) {
  const Eigen::Vector3d normal = 127.0 * normal_of(triangle.corners_m);
  for (const Eigen::Vector3d& corner_m : triangle.corners_m) {
    vertices.push_back(
        {.p_W_m = {static_cast<float>(corner_m.x()), static_cast<float>(corner_m.y()),
                   static_cast<float>(corner_m.z())},
         .normal = {static_cast<std::int8_t>(std::lround(normal.x())),
                    static_cast<std::int8_t>(std::lround(normal.y())),
                    static_cast<std::int8_t>(std::lround(normal.z())), 0},
         .colour = triangle.colour});
  }
}

void add_solid(const city::SolidMesh& mesh, const Colour& walls, const Colour& roof,
               std::vector<Painted>& triangles) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array corners_m{mesh.corners[a], mesh.corners[b], mesh.corners[c]};
    triangles.push_back(
        {.corners_m = corners_m, .colour = normal_of(corners_m).z() > kUpwards ? roof : walls});
  }
}

/// Where the lines of a terrain's grid are, with one more on either side.
std::vector<double> lines_of(double first_m, double cell_m, std::size_t count) {
  std::vector<double> lines_m{first_m - kBeyondRim_m};
  for (std::size_t i = 0; i < count; ++i) {
    lines_m.push_back(first_m + cell_m * static_cast<double>(i));
  }
  lines_m.push_back(lines_m.back() + kBeyondRim_m);
  return lines_m;
}

void add_terrain(const city::Terrain& terrain, std::vector<Painted>& triangles) {
  const auto x_m = lines_of(terrain.south_west_m.x(), terrain.cell_m, terrain.columns);
  const auto y_m = lines_of(terrain.south_west_m.y(), terrain.cell_m, terrain.rows);
  const auto clamped = [](std::size_t line, std::size_t count) {
    return std::min(line == 0 ? 0 : line - 1, count - 1);
  };
  const auto at = [&](std::size_t column, std::size_t row) {
    const std::size_t sample =
        clamped(row, terrain.rows) * terrain.columns + clamped(column, terrain.columns);
    return Eigen::Vector3d{x_m[column], y_m[row], terrain.height_m[sample]};
  };
  for (std::size_t row = 0; row + 1 < y_m.size(); ++row) {
    for (std::size_t column = 0; column + 1 < x_m.size(); ++column) {
      const Eigen::Vector3d south_west = at(column, row);
      const Eigen::Vector3d north_east = at(column + 1, row + 1);
      triangles.push_back({{south_west, at(column + 1, row), north_east}, kGroundColour});
      triangles.push_back({{south_west, north_east, at(column, row + 1)}, kGroundColour});
    }
  }
}

std::vector<Painted> painted(const city::City& city) {
  std::vector<Painted> triangles;
  for (const city::Building& building : city.buildings) {
    city::SolidMesh mesh;
    for (const city::Prism& prism : building.prisms) {
      mesh.add_prism(prism.footprint, prism.bottom_m, prism.top_m);
    }
    const Colour& walls = kWallColours[static_cast<std::size_t>(building.outer_walls)];
    add_solid(mesh, walls, roof_of(walls), triangles);
  }
  for (const city::Tree& tree : city.trees) {
    city::SolidMesh mesh;
    mesh.add_tree(tree);
    add_solid(mesh, kTreeColour, kTreeColour, triangles);
  }
  for (const city::Wood& wood : city.woods) {
    city::SolidMesh mesh;
    mesh.add_prism(wood.footprint, wood.bottom_m, wood.top_m);
    add_solid(mesh, kWoodColour, kWoodColour, triangles);
  }
  if (city.terrain) {
    add_terrain(*city.terrain, triangles);
  }
  return triangles;
}

}  // namespace

Scene scene_of(const city::City& city) {
  const std::vector<Painted> triangles = painted(city);
  std::map<std::pair<int, int>, std::vector<const Painted*>> by_tile;
  for (const Painted& triangle : triangles) {
    const Eigen::Vector3d& corner_m = triangle.corners_m[0];
    by_tile[{static_cast<int>(std::floor(corner_m.x() / kTileSide_m)),
             static_cast<int>(std::floor(corner_m.y() / kTileSide_m))}]
        .push_back(&triangle);
  }
  Scene scene{.vertices = {}, .tiles = {}, .has_flat_ground = !city.terrain.has_value()};
  scene.vertices.reserve(3 * triangles.size());
  for (const auto& [place, members] : by_tile) {
    Tile tile{.first_vertex = static_cast<std::uint32_t>(scene.vertices.size()),
              .vertices = static_cast<std::uint32_t>(3 * members.size()),
              .low_m = members.front()->corners_m[0],
              .high_m = members.front()->corners_m[0]};
    for (const Painted* const triangle : members) {
      for (const Eigen::Vector3d& corner_m : triangle->corners_m) {
        tile.low_m = tile.low_m.cwiseMin(corner_m);
        tile.high_m = tile.high_m.cwiseMax(corner_m);
      }
      add_triangle(*triangle, scene.vertices);
    }
    scene.tiles.push_back(tile);
  }
  return scene;
}

std::vector<Vertex> box_of(const Eigen::Vector3d& size_m) {
  const Eigen::Vector2d half_m = size_m.head<2>() / 2.0;
  city::SolidMesh mesh;
  mesh.add_prism({.outer = {{-half_m.x(), -half_m.y()},
                            {half_m.x(), -half_m.y()},
                            {half_m.x(), half_m.y()},
                            {-half_m.x(), half_m.y()}},
                  .courtyards = {}},
                 -size_m.z() / 2.0, size_m.z() / 2.0);
  std::vector<Painted> triangles;
  add_solid(mesh, kBodyColour, kBodyColour, triangles);
  std::vector<Vertex> vertices;
  for (const Painted& triangle : triangles) {
    add_triangle(triangle, vertices);
  }
  return vertices;
}

}  // namespace cuscus::camera
