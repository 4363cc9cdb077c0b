#pragma once

#include <filesystem>
#include <span>

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/import_report.h"

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

}  // namespace cuscus::city
