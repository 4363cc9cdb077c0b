#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/city/city.h"

namespace cuscus::camera {

/// A corner of a flat triangle, as the graphics card gets it.
struct Vertex {
  std::array<float, 3> p_W_m;
  std::array<std::int8_t, 4> normal;   ///< Of length 127; the last is 0.
  std::array<std::uint8_t, 4> colour;  ///< Red, green, blue in full light; 255: ground with checks.
};

/// Triangles that lie close together: drawn, or left out, as one.
struct Tile {
  std::uint32_t first_vertex{};
  std::uint32_t vertices{};
  Eigen::Vector3d low_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d high_m{Eigen::Vector3d::Zero()};
};

/// What stands still, three vertices a triangle, counter-clockwise from outside.
struct Scene {
  std::vector<Vertex> vertices;
  std::vector<Tile> tiles;
  /// The ground is the plane z = 0, which the vertices do not have.
  bool has_flat_ground{true};
};

/// Buildings by the material of their walls, trees, woods, and the terrain if there is one, which
/// goes on beyond its rim as high as that.
[[nodiscard]] Scene scene_of(const city::City& city);

/// A box around the origin.
[[nodiscard]] std::vector<Vertex> box_of(const Eigen::Vector3d& size_m);

}  // namespace cuscus::camera
