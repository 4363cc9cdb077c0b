#pragma once

#include "common/city/generate/convex_cell.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// A tree of a city: 6 ... 12 m high, its crown 1.5 ... 3 m in radius.
[[nodiscard]] Tree city_tree(const Eigen::Vector2d& foot, Dice& dice);

/// Trees along the inner side of a square's edges, about `spacing_m` apart.
void plant_around(const ConvexCell& square, double spacing_m, Dice& dice, std::vector<Tree>& trees);

/// Trees in a row from a to b, both ends included.
void plant_row(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double spacing_m, Dice& dice,
               std::vector<Tree>& trees);

/// The wood that covers a cell, 8 ... 14 m high.
[[nodiscard]] Wood wood_on(const ConvexCell& cell, Dice& dice);

}  // namespace cuscus::city::generate
