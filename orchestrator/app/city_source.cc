#include "orchestrator/app/city_source.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "common/city/generate/generate.h"
#include "common/city/import/import_city.h"
#include "common/city/transfer/city_message.h"
#include "common/posix/shared_memory.h"
#include "orchestrator/app/city_commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/print.h"

namespace cuscus::orchestrator {
namespace {

city::ImportOptions import_options(const scenario::CitySection& section, std::uint64_t seed) {
  city::ImportOptions options;
  options.rule = {.heights = {.lowest_m = section.heights_m[0], .highest_m = section.heights_m[1]},
                  .seed = seed,
                  .level_m = section.level_m,
                  .outer_walls = section.walls,
                  .room_m = section.room_m};
  if (!section.terrain.empty()) {
    options.terrain = city::TerrainFile{.file = section.terrain};
  }
  if (section.file && section.file->bounds_deg) {
    const auto& bounds = *section.file->bounds_deg;
    options.bounds = city::GeoBox{.west_deg = bounds[0],
                                  .south_deg = bounds[1],
                                  .east_deg = bounds[2],
                                  .north_deg = bounds[3]};
  }
  return options;
}

city::ImportedCity import_generated(const scenario::GeneratedCity& generated,
                                    city::ImportOptions options, std::uint64_t seed) {
  const city::generate::Request request{.style = generated.style == scenario::CityStyle::kOldTown
                                                     ? city::generate::Style::kOldTown
                                                     : city::generate::Style::kGrid,
                                        .seed = generated.seed.value_or(seed),
                                        .size_m = generated.size_m};
  options.origin = city::generate::default_origin(request.style);
  return city::import_city_text(city::generate::make_osm(request), city::OsmFormat::kXml,
                                "the generated city", options);
}

}  // namespace

std::string load_city(const scenario::Scenario& scenario) {
  if (!scenario.city) {
    return {};
  }
  const scenario::CitySection& section = *scenario.city;
  const city::ImportOptions options = import_options(section, scenario.seed);
  try {
    city::ImportedCity imported =
        section.file ? city::import_city(std::span{&section.file->file, 1}, options)
                     : import_generated(*section.generated, options, scenario.seed);
    const city::CityFigures& figures = imported.report.figures;
    print(stderr, "city: {} buildings up to {:.1f} m, {} streets, {} trees, {} woods\n",
          figures.buildings, figures.tallest_m, figures.streets, figures.trees, figures.woods);
    for (const std::string& remark : imported.report.remarks) {
      spdlog::warn("city: {}", remark);
    }
    if (section.file) {
      imported.city.attribution = labels_of({section.file->file}).attribution;
    }
    return city::to_message(imported.city).SerializeAsString();
  } catch (const city::CityFileError& error) {
    throw UsageError{error.what()};
  }
}

posix::UniqueFd city_memory(const std::string& message) {
  if (message.empty()) {
    return {};
  }
  auto memory = posix::create_shared_memory("cuscus-city", message.size());
  const auto mapping = posix::MemoryMapping::read_write(memory);
  std::ranges::copy(std::as_bytes(std::span{message}), mapping.writable_bytes().begin());
  posix::seal_against_new_writers(memory);
  return memory;
}

}  // namespace cuscus::orchestrator
