#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "common/city/import/import_report.h"
#include "common/city/import/osm_records.h"

namespace cuscus::city {

/// A file that no city can be made of: "FILE: cause".
struct CityFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The file formats that are read; their names' endings are .osm, .osm.gz, .osm.bz2, .osm.pbf.
enum class OsmFormat : std::uint8_t { kXml, kXmlGzip, kXmlBzip2, kPbf };

/// What reading may cost at most. The defaults suffice for the largest cities.
struct ReadLimits {
  std::uintmax_t file_bytes{2'000'000'000};  ///< Looked up before anything is read.
  std::size_t kept_bytes{2'000'000'000};     ///< Of nodes, ways and relations in memory.
};

struct ReadOptions {
  std::optional<GeoBox> bounds;  ///< What does not meet it is left out; none: everything is kept.
  ReadLimits limits;
  std::size_t file{0};  ///< For the records.
};

/// Reads buildings, their parts, woods, streets and trees. Areas are assembled from closed ways and
/// multipolygon relations; what cannot be assembled is reported. The order of objects in the file
/// does not matter. Objects that meet `bounds` are kept whole.
/// @throws CityFileError when the file cannot be read to its end or is too large.
[[nodiscard]] OsmRecords read_osm(const std::filesystem::path& file, const ReadOptions& options,
                                  FileReport& report);

/// The same from memory, which stays there meanwhile; report.file names it.
[[nodiscard]] OsmRecords read_osm(std::string_view content, OsmFormat format,
                                  const ReadOptions& options, FileReport& report);

}  // namespace cuscus::city
