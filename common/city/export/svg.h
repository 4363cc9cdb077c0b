#pragma once

#include <string>

#include "common/city/city.h"
#include "common/city/export/map_labels.h"

namespace cuscus::city {

/// A map of the city, north up: buildings shaded by height with a legend, streets with names where
/// there is room, trees and woods, scale, title and who made the data. The same bytes for the same
/// city.
[[nodiscard]] std::string svg_text(const City& city, const MapLabels& labels);

}  // namespace cuscus::city
