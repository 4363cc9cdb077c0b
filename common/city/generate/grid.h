#pragma once

#include <cstdint>

#include "common/city/generate/plan.h"

namespace cuscus::city::generate {

/// Heights are those that the paper draws for Manhattan: uniform, 50 ... 150 m.
struct GridParameters {
  double size_m{600.0};           ///< Side of the square.
  double avenues_apart_m{150.0};  ///< About: as many as fit.
  double streets_apart_m{80.0};
  double lowest_m{50.0};
  double highest_m{150.0};
};

/// Avenues of 25 to 30 m north and streets of 15 to 18 m east, between regular blocks of tall
/// buildings: wall to wall or alone on their lots, some with set-backs, some with a courtyard; one
/// block is a park. A pure function; throws std::invalid_argument for a size that check_size()
/// refuses.
[[nodiscard]] Plan grid(const GridParameters& parameters, std::uint64_t seed);

}  // namespace cuscus::city::generate
