#include "common/city/generate/osm_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/city/generate/osm_elements.h"
#include "common/city/names.h"

namespace cuscus::city::generate {
namespace {

constexpr double kStorey_m = 3.2;

/// 12.5 as "12.5", 12 as "12".
std::string number(double value) {
  std::string text = fmt::format("{:.3f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text;
}

void add_name(const std::string& name, Tags& tags) {
  if (!name.empty()) {
    tags.push_back({"name", name});
  }
}

void add_building(const PlannedBuilding& building, OsmElements& elements) {
  const double storeys = std::max(1.0, std::floor(building.height_m / kStorey_m));
  Tags tags{{"building", building.use},
            {"building:levels", number(storeys)},
            {"building:material", std::string{name_of(building.walls)}},
            {"height", number(building.height_m)}};
  add_name(building.name, tags);
  elements.add_area(building.footprint, std::move(tags));
  for (const Prism& part : building.parts) {
    Tags part_tags{{"building:part", "yes"},
                   {"building:material", std::string{name_of(building.walls)}},
                   {"height", number(part.top_m)}};
    if (part.bottom_m > 0.0) {
      part_tags.push_back({"min_height", number(part.bottom_m)});
    }
    elements.add_area(part.footprint, std::move(part_tags));
  }
}

void add_street(const PlannedStreet& street, OsmElements& elements) {
  Tags tags{{"highway", street.highway}, {"width", number(street.width_m)}};
  add_name(street.name, tags);
  elements.add_way(street.axis_m, std::move(tags));
}

}  // namespace

std::string osm_text(const Plan& plan, const Geodetic& origin) {
  OsmElements elements{origin};
  for (const PlannedBuilding& building : plan.buildings) {
    add_building(building, elements);
  }
  for (const PlannedStreet& street : plan.streets) {
    add_street(street, elements);
  }
  for (const Square& square : plan.squares) {
    Tags tags{{"place", "square"}};
    add_name(square.name, tags);
    elements.add_area({.outer = square.outline, .courtyards = {}}, std::move(tags));
  }
  for (const Wood& wood : plan.woods) {
    elements.add_area(wood.footprint, {{"natural", "wood"}, {"height", number(wood.top_m)}});
  }
  for (const Tree& tree : plan.trees) {
    elements.add_node(tree.foot_m.head<2>(),
                      {{"natural", "tree"},
                       {"height", number(tree.height_m)},
                       {"diameter_crown", number(2.0 * tree.crown_radius_m)}});
  }
  return elements.xml(plan.south_west_m, plan.north_east_m);
}

}  // namespace cuscus::city::generate
