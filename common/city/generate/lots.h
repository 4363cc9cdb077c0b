#pragma once

#include <vector>

#include "common/city/generate/convex_cell.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

struct LotSizes {
  double largest_m2{600.0};   ///< What is larger is divided,
  double smallest_m2{100.0};  ///< unless a part would be smaller than this
  double narrowest_m{7.0};    ///< or narrower than that.
};

/// Divides a block across its longest side, again and again, into lots that fill it.
[[nodiscard]] std::vector<ConvexCell> divided(const ConvexCell& block, const LotSizes& sizes,
                                              Dice& dice);

/// The lots' outlines in whole millimetres. A corner on the side of another lot becomes a corner of
/// that one too, so that common walls stay common whatever the corners are rounded to later.
[[nodiscard]] std::vector<Ring> outlines_with_common_corners(const std::vector<ConvexCell>& lots);

/// Corners in whole millimetres, none twice in a row.
[[nodiscard]] Ring snapped_ring(const Ring& ring);

/// The courtyard that leaves `depth_m` of building all around; clockwise. Empty where less than
/// `smallest_m2` would be left.
[[nodiscard]] Ring courtyard_in(const ConvexCell& lot, double depth_m, double smallest_m2);

}  // namespace cuscus::city::generate
