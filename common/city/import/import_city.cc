#include "common/city/import/import_city.h"

#include <iterator>
#include <utility>
#include <vector>

#include "common/city/import/build_city.h"
#include "common/city/import/read_osm.h"

namespace cuscus::city {
namespace {

template <typename Record>
void append(std::vector<Record>& all, std::vector<Record>&& more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

ImportedCity import_city(std::span<const std::filesystem::path> files,
                         const ImportOptions& options) {
  ImportedCity imported;
  imported.report.files.resize(files.size());
  OsmRecords all;
  for (std::size_t i = 0; i < files.size(); ++i) {
    OsmRecords records =
        read_osm(files[i], {.bounds = options.bounds, .limits = options.limits, .file = i},
                 imported.report.files[i]);
    append(all.areas, std::move(records.areas));
    append(all.streets, std::move(records.streets));
    append(all.trees, std::move(records.trees));
    if (records.extent) {
      all.extent = all.extent.value_or(*records.extent);
      all.extent->extend(*records.extent);
    }
  }
  imported.city = build_city(std::move(all), options, imported.report);
  return imported;
}

ImportedCity import_city_text(std::string_view content, OsmFormat format, const std::string& name,
                              const ImportOptions& options) {
  ImportedCity imported;
  imported.report.files.resize(1);
  imported.report.files[0].file = name;
  OsmRecords records =
      read_osm(content, format, {.bounds = options.bounds, .limits = options.limits},
               imported.report.files[0]);
  imported.city = build_city(std::move(records), options, imported.report);
  return imported;
}

}  // namespace cuscus::city
