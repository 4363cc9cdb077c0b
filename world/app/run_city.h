#pragma once

#include "common/city/city.h"
#include "common/city/geometry/city_geometry.h"

namespace cuscus::world {

/// What the world knows of the city that a fleet flies in.
struct RunCity {
  /// @throws std::invalid_argument as CityGeometry does.
  explicit RunCity(const city::City& city);

  city::CityGeometry geometry;
  city::Geodetic origin;
};

}  // namespace cuscus::world
