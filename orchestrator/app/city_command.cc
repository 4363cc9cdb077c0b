#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/city/import/import_city.h"
#include "common/scenario/units.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/city_report.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/degrees.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"

namespace cuscus::orchestrator {
namespace {

double height_m(const std::string& whole, const std::string& text) {
  try {
    return scenario::parse_quantity(text, scenario::kLength);
  } catch (const scenario::UnitError& error) {
    throw UsageError{fmt::format("--heights {}: {}", whole, error.what())};
  }
}

/// "10m..15m".
city::HeightRange heights_of(const std::string& text) {
  constexpr std::string_view kTo = "..";
  const auto to = text.find(kTo);
  if (to == std::string::npos) {
    throw UsageError{fmt::format("--heights {}: allowed: two lengths, such as 10m..15m", text)};
  }
  const city::HeightRange heights{height_m(text, text.substr(0, to)),
                                  height_m(text, text.substr(to + kTo.size()))};
  constexpr double kHighest_m = 1000.0;
  if (!(heights.lowest_m > 0.0 && heights.lowest_m <= heights.highest_m &&
        heights.highest_m <= kHighest_m)) {
    throw UsageError{
        fmt::format("--heights {}: allowed: above 0 m, up to 1000 m, the lower one first", text)};
  }
  return heights;
}

city::ImportOptions options_of(const CityArguments& arguments) {
  city::ImportOptions options;
  if (arguments.bounds) {
    const DegreeBox box = parse_degree_box("--bbox", *arguments.bounds);
    options.bounds = city::GeoBox{box.west, box.south, box.east, box.north};
  }
  if (arguments.heights) {
    options.rule.heights = heights_of(*arguments.heights);
  }
  if (arguments.terrain) {
    options.terrain = city::TerrainFile{.file = *arguments.terrain};
  }
  options.rule.seed = arguments.seed;
  return options;
}

}  // namespace

int city_command(const CityArguments& arguments) try {
  if (arguments.files.empty()) {
    throw UsageError{"city: a FILE is missing: .osm, .osm.gz, .osm.bz2 or .osm.pbf"};
  }
  if (arguments.out) {
    check_map_file(*arguments.out);
  }
  const city::ImportedCity imported = city::import_city(arguments.files, options_of(arguments));
  if (arguments.json) {
    // Names may be of any bytes.
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    print(stdout, "{}\n", city_json(imported).dump(2, ' ', false, kReplace));
  } else {
    print(stdout, "{}", city_text(imported));
  }
  if (arguments.out) {
    write_map(imported.city, labels_of(arguments.files), *arguments.out);
  }
  return kExitDone;
} catch (const city::CityFileError& error) {
  throw UsageError{error.what()};
}

}  // namespace cuscus::orchestrator
