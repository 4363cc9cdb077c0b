#pragma once

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/import_report.h"
#include "common/city/import/osm_records.h"

namespace cuscus::city {

/// A city from records, which the function sorts: their order has no effect. Fills in
/// report.figures, adds to report.files what is wrong with the records, and remarks on the whole.
/// @throws CityFileError when there are no buildings, or the records span more than a city
[[nodiscard]] City build_city(OsmRecords records, const ImportOptions& options,
                              ImportReport& report);

}  // namespace cuscus::city
