#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/import_report.h"
#include "common/city/import/read_osm.h"

namespace cuscus::city {

struct ImportedCity {
  City city;
  ImportReport report;
};

/// One city from one or more files of OpenStreetMap. The same files and options give the same city,
/// whatever the order of the files and of the objects in them.
/// @throws CityFileError naming the file and the cause
[[nodiscard]] ImportedCity import_city(std::span<const std::filesystem::path> files,
                                       const ImportOptions& options);

/// The same from the text of one file; `name` stands for it in messages.
/// @throws CityFileError
[[nodiscard]] ImportedCity import_city_text(std::string_view content, OsmFormat format,
                                            const std::string& name, const ImportOptions& options);

}  // namespace cuscus::city
