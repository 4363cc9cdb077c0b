#pragma once

#include <string>

#include "common/city/city.h"
#include "common/city/export/map_labels.h"

namespace cuscus::city {

/// The city as JSON: docs/city.md has the format. Metres to the millimetre; the same bytes for the
/// same city.
[[nodiscard]] std::string json_text(const City& city, const MapLabels& labels);

}  // namespace cuscus::city
