#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/city/city.h"
#include "common/city/geometry/city_geometry.h"

namespace cuscus::world {

/// What the world knows of the city that a fleet flies in.
struct RunCity {
  /// @throws std::invalid_argument as CityGeometry does.
  explicit RunCity(const city::City& city);

  city::CityGeometry geometry;
  city::Geodetic origin;
  std::vector<std::string> buildings;  ///< What a person may call each: building_label().
};

/// "building 12 (way 4711, 'Town Hall')", with as much of it as the map knows.
[[nodiscard]] std::string building_label(const city::Building& building, std::size_t index);

}  // namespace cuscus::world
