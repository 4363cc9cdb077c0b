#pragma once

#include <optional>

#include "common/city/generate/convex_cell.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// A nave with a tower at its front, along the longest side of the block and in its middle, as long
/// as the block allows; nothing in a block that is too small for a nave of 18 m.
[[nodiscard]] std::optional<PlannedBuilding> church_in(const ConvexCell& block, Dice& dice);

}  // namespace cuscus::city::generate
