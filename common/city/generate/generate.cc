#include "common/city/generate/generate.h"

#include "common/city/generate/grid.h"
#include "common/city/generate/old_town.h"
#include "common/city/generate/osm_writer.h"

namespace cuscus::city::generate {

std::optional<Style> style_of(std::string_view name) {
  if (name == "old-town") {
    return Style::kOldTown;
  }
  if (name == "grid") {
    return Style::kGrid;
  }
  return std::nullopt;
}

Geodetic default_origin(Style style) {
  return style == Style::kOldTown
             ? Geodetic{.latitude_deg = 44.5, .longitude_deg = 11.35, .height_m = 0.0}
             : Geodetic{.latitude_deg = 40.75, .longitude_deg = -73.98, .height_m = 0.0};
}

Plan make_plan(const Request& request) {
  return request.style == Style::kOldTown ? old_town({.size_m = request.size_m}, request.seed)
                                          : grid({.size_m = request.size_m}, request.seed);
}

std::string make_osm(const Request& request) {
  return osm_text(make_plan(request), request.origin.value_or(default_origin(request.style)));
}

}  // namespace cuscus::city::generate
