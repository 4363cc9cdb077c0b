#pragma once

#include <cstddef>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// Of cut footprints, pieces narrower than this on average are dropped [m]: outlines and parts are
/// drawn by hand, and their edges miss one another by centimetres.
inline constexpr double kThinnestPiece_m = 0.3;

struct UnitedPrisms {
  std::vector<Prism> prisms;
  std::vector<std::size_t> hidden_parts;  ///< Of which nothing is left beside the others.
};

/// One building's prisms without shared volume. Where parts cover the outline, they replace it from
/// the ground to the sky, voids under them included; the rest of the outline stays. Where two parts
/// claim one place at one height, the higher part has it, and the larger one of two equally high.
[[nodiscard]] UnitedPrisms unite_parts(const std::vector<Prism>& outlines,
                                       const std::vector<Prism>& parts);

}  // namespace cuscus::city
