#pragma once

#include "common/city/city.h"

namespace cuscus::city {

/// @throws std::invalid_argument naming the body of which no geometry can be made, and why.
void check_city(const City& city);

}  // namespace cuscus::city
