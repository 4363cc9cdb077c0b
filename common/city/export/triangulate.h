#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// Three corners of a flat figure, counter-clockwise.
using Triangle = std::array<std::uint32_t, 3>;

struct FlatMesh {
  std::vector<Eigen::Vector2d> corners;  ///< The outer ring's, then each courtyard's, in order.
  std::vector<Triangle> triangles;
};

/// A footprint in triangles that use its corners and no others: every side of a ring is the side of
/// one triangle, every other side that of two. By ear clipping, after each courtyard has been
/// joined to the outer ring by a bridge (D. Eberly, "Triangulation by Ear Clipping", Geometric
/// Tools, 2002): O(n^2) for n corners. Of a footprint that is not simple, triangles may overlap.
[[nodiscard]] FlatMesh triangulated(const Footprint& footprint);

}  // namespace cuscus::city
