#include "common/city/export/json.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/city/names.h"

namespace cuscus::city {
namespace {

/// Metres to the millimetre, without zeros that say nothing.
std::string metres(double value) {
  const double rounded = std::round(value * 1000.0) / 1000.0;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);  // no -0.0
}

std::string quoted(const std::string& text) {
  // What is not UTF-8 becomes U+FFFD.
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string point(const Eigen::Vector2d& p) {
  return fmt::format("[{},{}]", metres(p.x()), metres(p.y()));
}

/// "[a,b,c]", of each item what `text` makes of it.
template <typename Items, typename Text>
std::string list(const Items& items, const Text& text, const char* separator = ",") {
  std::string out = "[";
  const char* before = "";
  for (const auto& item : items) {
    out += before;
    out += text(item);
    before = separator;
  }
  return out + "]";
}

std::string rings(const Footprint& footprint) {
  const auto ring = [](const Ring& corners) { return list(corners, point); };
  return fmt::format("\"outer\":{},\"courtyards\":{}", ring(footprint.outer),
                     list(footprint.courtyards, ring));
}

std::string prism_json(const Prism& prism) {
  return fmt::format("{{\"bottom_m\":{},\"top_m\":{},{}}}", metres(prism.bottom_m),
                     metres(prism.top_m), rings(prism.footprint));
}

std::string building_json(const Building& building) {
  return fmt::format(
      "{{\"osm_id\":{},\"name\":{},\"outer_walls\":\"{}\",\"room_m\":{},\"height_source\":\"{}\","
      "\"prisms\":{}}}",
      building.osm_id, quoted(building.name), name_of(building.outer_walls),
      metres(building.room_m), name_of(building.height_source), list(building.prisms, prism_json));
}

std::string street_json(const Street& street) {
  return fmt::format("{{\"osm_id\":{},\"name\":{},\"width_m\":{},\"axis_m\":{}}}", street.osm_id,
                     quoted(street.name), metres(street.width_m), list(street.axis_m, point));
}

std::string tree_json(const Tree& tree) {
  return fmt::format("{{\"foot_m\":[{},{},{}],\"height_m\":{},\"crown_radius_m\":{}}}",
                     metres(tree.foot_m.x()), metres(tree.foot_m.y()), metres(tree.foot_m.z()),
                     metres(tree.height_m), metres(tree.crown_radius_m));
}

std::string wood_json(const Wood& wood) {
  return prism_json({wood.footprint, wood.bottom_m, wood.top_m});
}

std::string terrain_json(const Terrain& terrain) {
  return fmt::format(
      "{{\"south_west_m\":{},\"cell_m\":{},\"columns\":{},\"rows\":{},\"height_m\":{}}}",
      point(terrain.south_west_m), metres(terrain.cell_m), terrain.columns, terrain.rows,
      list(terrain.height_m, [](float height_m) { return metres(height_m); }));
}

}  // namespace

std::string json_text(const City& city, const MapLabels& labels) {
  std::string out = "{\n\"format\":\"cuscus-map\",\n\"version\":1,\n";
  const auto add = [&](const char* key, const std::string& value, const char* end = ",\n") {
    fmt::format_to(std::back_inserter(out), "\"{}\":{}{}", key, value, end);
  };
  add("title", quoted(labels.title));
  add("attribution", quoted(labels.attribution));
  add("origin",
      fmt::format("{{\"latitude_deg\":{},\"longitude_deg\":{},\"height_m\":{}}}",
                  city.origin.latitude_deg, city.origin.longitude_deg, city.origin.height_m));
  add("south_west_m", point(city.south_west_m));
  add("north_east_m", point(city.north_east_m));
  add("buildings", list(city.buildings, building_json, ",\n"));
  add("streets", list(city.streets, street_json, ",\n"));
  add("trees", list(city.trees, tree_json, ",\n"));
  add("woods", list(city.woods, wood_json, ",\n"));
  add("terrain", city.terrain ? terrain_json(*city.terrain) : "null", "\n");
  return out + "}\n";
}

}  // namespace cuscus::city
