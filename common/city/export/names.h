#pragma once

#include "common/city/city.h"

namespace cuscus::city {

/// "stone", "concrete", ...
[[nodiscard]] const char* name_of(Material material);

/// "tag", "levels" or "rule".
[[nodiscard]] const char* name_of(HeightSource source);

}  // namespace cuscus::city
