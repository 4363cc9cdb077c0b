#pragma once

#include <cstdint>

#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// Heights are those that the paper draws for Bologna: uniform, 10 ... 15 m.
struct OldTownParameters {
  double size_m{600.0};   ///< Side of the square.
  double block_m{46.0};   ///< From the middle of one street to that of the next, about.
  double lowest_m{10.0};  ///< Of the houses.
  double highest_m{15.0};
};

/// Crooked streets of 2.5 to 8 m between low, irregular blocks: houses wall to wall, palaces around
/// courtyards, two squares with trees, a church with a tower, a garden. A pure function; throws
/// std::invalid_argument for a size that check_size() refuses.
[[nodiscard]] Plan old_town(const OldTownParameters& parameters, std::uint64_t seed);

}  // namespace cuscus::city::generate
