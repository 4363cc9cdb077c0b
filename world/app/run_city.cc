#include "world/app/run_city.h"

namespace cuscus::world {
namespace {

std::vector<std::string> labels_of(const std::vector<city::Building>& buildings) {
  std::vector<std::string> labels;
  labels.reserve(buildings.size());
  for (const city::Building& building : buildings) {
    labels.push_back(building_label(building, labels.size()));
  }
  return labels;
}

}  // namespace

RunCity::RunCity(const city::City& city)
    : geometry{city}, origin{city.origin}, buildings{labels_of(city.buildings)} {}

std::string building_label(const city::Building& building, std::size_t index) {
  std::string known;
  if (building.osm_id != 0) {
    known = (building.osm_id > 0 ? "way " : "relation ") +
            std::to_string(building.osm_id > 0 ? building.osm_id : -building.osm_id);
  }
  if (!building.name.empty()) {
    known += (known.empty() ? "'" : ", '") + building.name + '\'';
  }
  return "building " + std::to_string(index) + (known.empty() ? "" : " (" + known + ')');
}

}  // namespace cuscus::world
