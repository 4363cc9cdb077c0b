#pragma once

#include "common/city/generate/convex_cell.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// A building of `height_m` on a lot of that outline: a tower on a base, one that steps back twice,
/// one around a courtyard, or a plain one, as the dice and the lot's size have it.
[[nodiscard]] PlannedBuilding tall_building(const ConvexCell& lot, const Ring& outline,
                                            double height_m, Dice& dice);

}  // namespace cuscus::city::generate
