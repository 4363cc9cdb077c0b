#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// Corners and triangles in ENU metres; a triangle's corners go round counter-clockwise as seen
/// from outside. Of the solids that are added each is closed: every side belongs to two triangles.
struct SolidMesh {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  void add_prism(const Footprint& footprint, double bottom_m, double top_m);
  /// A trunk, and a crown around it in the upper part of the tree.
  void add_tree(const Tree& tree);
  /// The terrain, or a flat rectangle where there is none. Not closed.
  void add_ground(const City& city);
};

}  // namespace cuscus::city
