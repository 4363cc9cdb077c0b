#pragma once

#include <cstdint>
#include <vector>

#include "common/city/generate/convex_cell.h"

namespace cuscus::city::generate {

struct CellPattern {
  double size_m{600.0};  ///< Side of the square, about (0, 0), that the cells divide.
  double pitch_m{50.0};  ///< Mean distance of neighbouring sites, about.
};

/// The Voronoi cells of sites that lie irregularly in a square: each site somewhere in its field
/// of a chessboard, some fields without one. Cell i has `across` j where cell j is its neighbour,
/// and rectangle()'s numbers at the square's sides.
[[nodiscard]] std::vector<ConvexCell> irregular_cells(const CellPattern& pattern,
                                                      std::uint64_t seed);

}  // namespace cuscus::city::generate
