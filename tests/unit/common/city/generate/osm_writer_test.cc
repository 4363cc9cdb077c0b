#include "common/city/generate/osm_writer.h"

#include <GeographicLib/LocalCartesian.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <catch2/catch.hpp>
#include <map>
#include <sstream>
#include <string>

#include "common/city/generate/generate.h"
#include "common/city/generate/osm_elements.h"

namespace cuscus::city::generate {
namespace {

namespace pt = boost::property_tree;

constexpr Geodetic kOrigin{.latitude_deg = 44.5, .longitude_deg = 11.35, .height_m = 0.0};

/// The file, read by a parser that is not ours.
pt::ptree parsed(const std::string& xml) {
  std::istringstream text{xml};
  pt::ptree tree;
  pt::read_xml(text, tree, pt::xml_parser::trim_whitespace);
  return tree.get_child("osm");
}

std::map<std::string, std::string> tags_of(const pt::ptree& element) {
  std::map<std::string, std::string> tags;
  for (const auto& [name, child] : element) {
    if (name == "tag") {
      tags[child.get<std::string>("<xmlattr>.k")] = child.get<std::string>("<xmlattr>.v");
    }
  }
  return tags;
}

std::vector<pt::ptree> elements_of(const pt::ptree& osm, const std::string& type) {
  std::vector<pt::ptree> elements;
  for (const auto& [name, child] : osm) {
    if (name == type) {
      elements.push_back(child);
    }
  }
  return elements;
}

Footprint square(double from_m, double to_m) {
  return {.outer = {{from_m, from_m}, {to_m, from_m}, {to_m, to_m}, {from_m, to_m}},
          .courtyards = {}};
}

}  // namespace

TEST_CASE("Points come back as the metres that they were, within 0.1 mm, at 5 km too") {
  const GeographicLib::LocalCartesian frame{kOrigin.latitude_deg, kOrigin.longitude_deg, 0.0};
  for (const Eigen::Vector2d& p_m :
       {Eigen::Vector2d{0.0, 0.0}, Eigen::Vector2d{12.345, -0.678}, Eigen::Vector2d{-300.0, 300.0},
        Eigen::Vector2d{2500.0, 2500.0}, Eigen::Vector2d{-5000.0, 1.0}}) {
    const OsmPoint point = osm_point(p_m, kOrigin);

    double x_m = 0.0;
    double y_m = 0.0;
    double z_m = 0.0;
    frame.Forward(std::stod(degrees(point.latitude)), std::stod(degrees(point.longitude)), 0.0, x_m,
                  y_m, z_m);

    // Half a step of 1e-9 degrees is 0.056 mm in each direction.
    REQUIRE((Eigen::Vector2d{x_m, y_m} - p_m).norm() < 1e-4);
  }
}

TEST_CASE("Degrees have nine digits, west and south are negative") {
  REQUIRE(degrees(44'500'000'000) == "44.500000000");
  REQUIRE(degrees(-73'980'000'001) == "-73.980000001");
  REQUIRE(degrees(-1) == "-0.000000001");
}

TEST_CASE("Buildings, parts, courtyards, streets and trees have OSM's tags") {
  Plan plan;
  plan.south_west_m = {-50.0, -50.0};
  plan.north_east_m = {50.0, 50.0};
  PlannedBuilding tower{.use = "office",
                        .name = "Rope & \"Sons\" <1>",
                        .footprint = square(0.0, 20.0),
                        .height_m = 80.5,
                        .walls = Material::kGlass,
                        .parts = {{square(0.0, 20.0), 0.0, 30.0}, {square(5.0, 15.0), 30.0, 80.5}}};
  PlannedBuilding palace{.use = "palace",
                         .name = {},
                         .footprint = square(-40.0, -10.0),
                         .height_m = 12.0,
                         .walls = Material::kStone,
                         .parts = {}};
  palace.footprint.courtyards = {{{-30.0, -30.0}, {-30.0, -20.0}, {-20.0, -20.0}, {-20.0, -30.0}}};
  plan.buildings = {tower, palace};
  plan.streets = {{"residential", "Salt Row", {{-50.0, 25.0}, {50.0, 25.0}}, 4.5}};
  plan.trees = {{.foot_m = {30.0, 30.0, 0.0}, .height_m = 8.0, .crown_radius_m = 1.5}};
  plan.woods = {{square(35.0, 45.0), 0.0, 11.0}};

  const pt::ptree osm = parsed(osm_text(plan, kOrigin));
  const auto ways = elements_of(osm, "way");
  const auto relations = elements_of(osm, "relation");

  REQUIRE(osm.get<std::string>("<xmlattr>.version") == "0.6");
  using Map = std::map<std::string, std::string>;
  REQUIRE(tags_of(ways.at(0)) == Map{{"building", "office"},
                                     {"building:levels", "25"},  // 80.5 m of 3.2 m
                                     {"building:material", "glass"},
                                     {"height", "80.5"},
                                     {"name", "Rope & \"Sons\" <1>"}});
  REQUIRE(tags_of(ways.at(1)) ==
          Map{{"building:part", "yes"}, {"building:material", "glass"}, {"height", "30"}});
  REQUIRE(tags_of(ways.at(2)).at("min_height") == "30");
  REQUIRE(tags_of(ways.at(3)).empty());
  REQUIRE(tags_of(ways.at(4)).empty());
  REQUIRE(tags_of(relations.at(0)).at("type") == "multipolygon");
  REQUIRE(tags_of(relations.at(0)).at("height") == "12");
  REQUIRE(elements_of(relations.at(0), "member").size() == 2);
  REQUIRE(tags_of(ways.at(5)) ==
          Map{{"highway", "residential"}, {"name", "Salt Row"}, {"width", "4.5"}});
  REQUIRE(tags_of(ways.at(6)) == Map{{"natural", "wood"}, {"height", "11"}});
  REQUIRE(tags_of(elements_of(osm, "node").back()) ==
          Map{{"natural", "tree"}, {"height", "8"}, {"diameter_crown", "3"}});
}

TEST_CASE("Shapes with a corner in common share its node, and rings are closed") {
  Plan plan;
  for (const double west_m : {0.0, 10.0}) {
    PlannedBuilding house{.use = "house",
                          .name = {},
                          .footprint = {},
                          .height_m = 10.0,
                          .walls = Material::kBrick,
                          .parts = {}};
    house.footprint.outer = {
        {west_m, 0.0}, {west_m + 10.0, 0.0}, {west_m + 10.0, 10.0}, {west_m, 10.0}};
    plan.buildings.push_back(house);
  }

  const pt::ptree osm = parsed(osm_text(plan, kOrigin));

  REQUIRE(elements_of(osm, "node").size() == 6);
  for (const pt::ptree& way : elements_of(osm, "way")) {
    const auto nodes = elements_of(way, "nd");
    REQUIRE(nodes.size() == 5);
    REQUIRE(nodes.front().get<int>("<xmlattr>.ref") == nodes.back().get<int>("<xmlattr>.ref"));
  }
}

TEST_CASE("The middle of the file's bounds is the origin") {
  const pt::ptree osm = parsed(make_osm({.style = Style::kGrid, .size_m = 300.0}));
  const auto bound = [&](const char* name) {
    return osm.get<double>(std::string{"bounds.<xmlattr>."} + name);
  };

  REQUIRE((bound("minlat") + bound("maxlat")) / 2.0 == Approx(40.75).margin(1e-12));
  REQUIRE((bound("minlon") + bound("maxlon")) / 2.0 == Approx(-73.98).margin(1e-12));
}

TEST_CASE("A request gives the same bytes each time") {
  const Request request{.style = Style::kOldTown, .seed = 7, .size_m = 250.0};

  REQUIRE(make_osm(request) == make_osm(request));
}

TEST_CASE("The shipped generators are known by name") {
  REQUIRE(style_of("old-town") == Style::kOldTown);
  REQUIRE(style_of("grid") == Style::kGrid);
  REQUIRE_FALSE(style_of("suburb").has_value());
}

}  // namespace cuscus::city::generate
