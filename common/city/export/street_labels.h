#pragma once

#include <string>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// A street's name on a map. East and south of the map's north-western corner, in its own units.
struct StreetLabel {
  std::string name;
  Eigen::Vector2d middle{Eigen::Vector2d::Zero()};
  double angle_deg{0.0};  ///< Clockwise; never upside down.
  double size{0.0};       ///< Of the letters.
};

/// Names where a street is straight for long enough, no two of them on each other, and the same
/// name again only far away.
[[nodiscard]] std::vector<StreetLabel> street_labels(const City& city, double units_per_m);

}  // namespace cuscus::city
