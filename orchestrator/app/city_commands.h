#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/city/city.h"
#include "common/city/export/map_labels.h"

namespace cuscus::orchestrator {

/// What `cuscus city generate` is asked for, as it was written.
struct CityGenerateArguments {
  std::string style;  ///< "old-town" or "grid".
  std::uint64_t seed{1};
  std::string size{"600m"};
  std::optional<std::string> origin;  ///< "LATITUDE,LONGITUDE" in degrees.
  std::filesystem::path out;
};
/// Writes a city that nobody has surveyed as an OSM file.
int city_generate_command(const CityGenerateArguments& arguments);

/// What `cuscus city fetch` is asked for, as it was written.
struct CityFetchArguments {
  std::string bounds;  ///< "W,S,E,N" in degrees.
  std::string server;  ///< URL of an Overpass interpreter.
  std::filesystem::path out;
  std::string timeout{"180s"};
  std::uint64_t largest_mb{512};
};
/// Downloads an extract of OpenStreetMap from an Overpass server.
int city_fetch_command(const CityFetchArguments& arguments);

/// Title and attribution for a map made of these files: OpenStreetMap's, unless all of them are
/// made up by `cuscus city generate`.
[[nodiscard]] city::MapLabels labels_of(const std::vector<std::filesystem::path>& files);

/// Refuses, as wrong usage, a name that no map can be written to: an ending that is none of a
/// map's, a file that exists.
void check_map_file(const std::filesystem::path& out);

/// Writes a map of the city: *.json, *.svg or *.glb.
void write_map(const city::City& city, const city::MapLabels& labels,
               const std::filesystem::path& out);

}  // namespace cuscus::orchestrator
