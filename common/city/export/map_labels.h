#pragma once

#include <string>

namespace cuscus::city {

/// What a map says of itself.
struct MapLabels {
  std::string title;
  /// Who made the data, such as kOsmAttribution; empty for a city that nobody surveyed.
  std::string attribution;
};

/// What the Open Database Licence asks of whoever shows data of OpenStreetMap.
inline constexpr const char* kOsmAttribution =
    "© OpenStreetMap contributors, ODbL 1.0, openstreetmap.org/copyright";

}  // namespace cuscus::city
