#include "common/city/import/build_city.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "common/city/import/footprints.h"
#include "common/city/import/import_city.h"
#include "common/city/import/read_osm.h"
#include "tests/support/osm_text.h"
#include "tests/support/temporary_folder.h"

namespace cuscus::city {
namespace {

using Catch::Contains;

// On the equator a unit of OsmText::box, 0.0001 degrees, has 11.132 m eastwards (of the radius
// 6378137 m) and 11.057 m northwards (of the meridian's radius there, a (1 - e^2) = 6335439 m).
constexpr double kEast_m = 6378137.0 * 1e-4 * 3.14159265358979 / 180.0;
constexpr double kNorth_m = 6335439.327 * 1e-4 * 3.14159265358979 / 180.0;

struct Built {
  City city;
  ImportReport report;

  [[nodiscard]] const Finding& of(Problem problem) const { return report.files[0].of(problem); }
  [[nodiscard]] const Building& building(std::int64_t osm_id) const {
    const auto found = std::ranges::find(city.buildings, osm_id, &Building::osm_id);
    REQUIRE(found != city.buildings.end());
    return *found;
  }
  [[nodiscard]] double top_m(std::int64_t osm_id) const {
    double top = 0.0;
    for (const Prism& prism : building(osm_id).prisms) {
      top = std::max(top, prism.top_m);
    }
    return top;
  }
};

Built build(const OsmText& osm, const ImportOptions& options = {}) {
  Built built;
  built.report.files.resize(1);
  const std::string text = osm.text();
  OsmRecords records = read_osm(text, OsmFormat::kXml, {.bounds = options.bounds, .limits = {}},
                                built.report.files[0]);
  built.city = build_city(std::move(records), options, built.report);
  return built;
}

OsmText::TagList house(const std::string& key, const std::string& value) {
  return {{"building", "yes"}, {key, value}};
}

TEST_CASE("a footprint is in metres around the centre of the buildings") {
  const Built built = build(OsmText{}.box(1, -1, -1, 1, 1, house("height", "12")));

  const Footprint& footprint = built.building(1).prisms.at(0).footprint;
  const auto box = bounds_of(footprint);
  CHECK(built.city.origin.latitude_deg == Approx(0.0).margin(1e-12));
  CHECK(box.min().x() == Approx(-kEast_m).epsilon(1e-6));
  CHECK(box.max().y() == Approx(kNorth_m).epsilon(1e-6));
  CHECK(area_m2(footprint) == Approx(4.0 * kEast_m * kNorth_m).epsilon(1e-6));
  CHECK(built.report.figures.footprint_m2 == Approx(4.0 * kEast_m * kNorth_m).epsilon(1e-6));
  CHECK(built.city.south_west_m.x() == Approx(-kEast_m).epsilon(1e-6));
}

TEST_CASE("heights come from the tag, else from levels and roof, else from the rule") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, house("height", "40 ft"))
      .box(2, 2, 0, 3, 1, house("building:levels", "4"))
      .box(3, 4, 0, 5, 1, {{"building", "yes"}, {"building:levels", "4"}, {"roof:levels", "1"}})
      .box(4, 6, 0, 7, 1, {{"building", "yes"}, {"building:levels", "4"}, {"roof:height", "2.5"}})
      .box(5, 8, 0, 9, 1, house("height", "3 storeys"))
      .box(6, 10, 0, 11, 1, house("height", "-5"))
      .box(7, 12, 0, 13, 1, {{"building", "yes"}, {"height", "1e9"}, {"building:levels", "2"}});
  ImportOptions options;
  options.rule.level_m = 3.5;

  const Built built = build(osm, options);

  CHECK(built.top_m(1) == Approx(12.192));
  CHECK(built.top_m(2) == Approx(14.0));
  CHECK(built.top_m(3) == Approx(17.5));
  CHECK(built.top_m(4) == Approx(16.5));
  for (const int id : {5, 6}) {
    CHECK(built.building(id).height_source == HeightSource::kRule);
    CHECK(built.top_m(id) >= 10.0);
    CHECK(built.top_m(id) < 15.0);
  }
  CHECK(built.top_m(7) == Approx(7.0));
  CHECK(built.building(7).height_source == HeightSource::kLevels);
  CHECK(built.of(Problem::kBadHeight).count == 3);
  CHECK(built.of(Problem::kBadHeight).examples.at(0).detail == "height=3 storeys");
  CHECK(built.report.figures.height_from_tag == 1);
  CHECK(built.report.figures.height_from_levels == 4);
  CHECK(built.report.figures.height_from_rule == 2);
  CHECK(built.report.figures.tallest_osm_id == 3);
  CHECK(built.report.figures.tallest_m == Approx(17.5));
}

TEST_CASE("a height by the rule depends on the seed and the building alone") {
  OsmText both;
  both.box(1, 0, 0, 1, 1, {{"building", "yes"}}).box(2, 2, 0, 3, 1, {{"building", "yes"}});
  OsmText second_alone;
  second_alone.box(2, 2, 0, 3, 1, {{"building", "yes"}});
  ImportOptions other_seed;
  other_seed.rule.seed = 2;

  CHECK(build(both).top_m(2) == build(second_alone).top_m(2));
  CHECK(build(both).top_m(1) != build(both).top_m(2));
  CHECK(build(both, other_seed).top_m(2) != build(both).top_m(2));
}

TEST_CASE("heights by the rule fill their range evenly") {
  OsmText osm;
  constexpr int kHouses = 1000;
  for (int i = 1; i <= kHouses; ++i) {
    osm.box(i, 2 * i, 0, 2 * i + 1, 1, {{"building", "yes"}});
  }
  ImportOptions options;
  options.rule.heights = {50.0, 150.0};

  const Built built = build(osm, options);

  double sum = 0.0;
  double lowest = 1e9;
  double highest = 0.0;
  for (const Building& building : built.city.buildings) {
    const double top = building.prisms.at(0).top_m;
    sum += top;
    lowest = std::min(lowest, top);
    highest = std::max(highest, top);
  }
  // The mean of 1000 uniform draws has a standard deviation of 100 / sqrt(12 * 1000) = 0.91 m.
  CHECK(sum / kHouses == Approx(100.0).margin(4.0));
  CHECK(lowest >= 50.0);
  CHECK(lowest < 51.5);
  CHECK(highest < 150.0);
  CHECK(highest > 148.5);
}

TEST_CASE("a building begins at its minimum height, a canopy is a plate") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, {{"building", "yes"}, {"height", "20"}, {"min_height", "5"}})
      .box(2, 2, 0, 3, 1, {{"building", "yes"}, {"height", "20"}, {"building:min_level", "2"}})
      .box(3, 4, 0, 5, 1, {{"building", "yes"}, {"height", "20"}, {"min_height", "30"}})
      .box(4, 6, 0, 7, 1, {{"building", "roof"}, {"height", "6"}});

  const Built built = build(osm);

  CHECK(built.building(1).prisms.at(0).bottom_m == Approx(5.0));
  CHECK(built.building(2).prisms.at(0).bottom_m == Approx(6.0));
  CHECK(built.building(3).prisms.at(0).bottom_m == 0.0);
  CHECK(built.of(Problem::kBottomAboveTop).count == 1);
  CHECK(built.building(4).prisms.at(0).bottom_m == Approx(5.7));
}

TEST_CASE(
    "parts belong to the building that they stand in, and take its height without their own") {
  OsmText osm;
  osm.box(1, 0, 0, 4, 4, house("height", "20"))
      .box(2, 10, 0, 14, 4, house("height", "30"))
      .box(3, 0, 0, 2, 4, {{"building:part", "yes"}, {"height", "50"}})
      .box(4, 11, 1, 12, 2, {{"building:part", "yes"}})
      .box(5, 20, 0, 21, 1, {{"building:part", "yes"}, {"height", "7"}});

  const Built built = build(osm);

  CHECK(built.city.buildings.size() == 3);
  CHECK(built.building(1).prisms.size() == 2);
  CHECK(built.top_m(1) == Approx(50.0));
  CHECK(built.building(2).prisms.size() == 2);
  CHECK(built.top_m(2) == Approx(30.0));
  CHECK(built.top_m(5) == Approx(7.0));
  CHECK(built.of(Problem::kPartAlone).count == 1);
  CHECK(built.report.figures.building_areas == 2);
  CHECK(built.report.figures.part_areas == 3);
  // Two outlines and the lonely part: parts within outlines are no more ground.
  CHECK(built.report.figures.footprint_m2 == Approx(33.0 * kEast_m * kNorth_m).epsilon(1e-6));
}

TEST_CASE("walls are of the tagged material, else of the scenario's") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, house("building:material", "sandstone"))
      .box(2, 2, 0, 3, 1, house("building:material", "cheese"))
      .box(3, 4, 0, 5, 1, house("building:facade:material", "glass"))
      .box(4, 6, 0, 9, 3, {{"building", "yes"}})
      .box(5, 6, 0, 8, 3, {{"building:part", "yes"}, {"building:material", "brick"}});
  ImportOptions options;
  options.rule.outer_walls = Material::kMetal;
  options.rule.room_m = 5.0;

  const Built built = build(osm, options);

  CHECK(built.building(1).outer_walls == Material::kStone);
  CHECK(built.building(2).outer_walls == Material::kMetal);
  CHECK(built.building(3).outer_walls == Material::kGlass);
  CHECK(built.building(4).outer_walls == Material::kBrick);
  CHECK(built.building(1).room_m == 5.0);
  CHECK(built.of(Problem::kUnknownMaterial).examples.at(0).detail == "cheese");
}

TEST_CASE("a palace of a relation has a courtyard, and one of two wings is one building") {
  OsmText osm;
  osm.box(1, 0, 0, 10, 10, {})
      .box(2, 4, 4, 6, 6, {})
      .box(3, 20, 0, 21, 1, {})
      .relation(7, {{1, "outer"}, {2, "inner"}, {3, "outer"}},
                {{"type", "multipolygon"}, {"building", "yes"}, {"height", "18"}});

  const Built built = build(osm);

  CHECK(built.city.buildings.size() == 1);
  const Building& palace = built.building(-7);
  REQUIRE(palace.prisms.size() == 2);
  CHECK(palace.prisms[0].footprint.courtyards.size() +
            palace.prisms[1].footprint.courtyards.size() ==
        1);
  CHECK(built.report.figures.footprint_m2 == Approx(97.0 * kEast_m * kNorth_m).epsilon(1e-6));
}

TEST_CASE("streets have widths by tag, by lanes or by class, and end at the box's edge") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, {{"building", "yes"}})
      .node(1, -0.001, 0.0)
      .node(2, 0.001, 0.0)
      .way(11, {1, 2}, {{"highway", "residential"}, {"name", "Via Zamboni"}, {"width", "6,5 m"}})
      .way(12, {1, 2}, {{"highway", "primary"}, {"lanes", "3"}})
      .way(13, {1, 2}, {{"highway", "footway"}, {"width", "narrow"}})
      .way(14, {1, 2}, {{"highway", "construction"}})
      .way(15, {1, 2}, {{"highway", "primary"}, {"tunnel", "yes"}});
  ImportOptions options;
  options.bounds = GeoBox{-0.0005, -0.0005, 0.0005, 0.0005};

  const Built built = build(osm, options);

  REQUIRE(built.city.streets.size() == 3);
  CHECK(built.city.streets[0].name == "Via Zamboni");
  CHECK(built.city.streets[0].width_m == Approx(6.5));
  CHECK(built.city.streets[0].axis_m.front().x() == Approx(-5.0 * kEast_m).epsilon(1e-5));
  CHECK(built.city.streets[0].axis_m.back().x() == Approx(5.0 * kEast_m).epsilon(1e-5));
  CHECK(built.city.streets[1].width_m == Approx(10.5));
  CHECK(built.city.streets[2].width_m == Approx(2.0));
  CHECK(built.of(Problem::kBadWidth).examples.at(0).detail == "width=narrow");
  CHECK(built.of(Problem::kUnderGround).count == 1);
  CHECK(built.report.figures.street_length_m == Approx(30.0 * kEast_m).epsilon(1e-5));
}

TEST_CASE("trees and woods have the height of their tags, else the rule's") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, {{"building", "yes"}})
      .node(1, 0.0001, 0.0, {{"natural", "tree"}, {"height", "18"}, {"diameter_crown", "8"}})
      .node(2, 0.0002, 0.0, {{"natural", "tree"}, {"height", "500"}})
      .box(3, 4, 0, 6, 2, {{"natural", "wood"}, {"height", "22"}})
      .box(4, 7, 0, 8, 1, {{"landuse", "forest"}});

  const Built built = build(osm);

  REQUIRE(built.city.trees.size() == 2);
  CHECK(built.city.trees[0].height_m == 18.0);
  CHECK(built.city.trees[0].crown_radius_m == 4.0);
  CHECK(built.city.trees[1].height_m == CityRule{}.tree_height_m);
  CHECK(built.of(Problem::kBadTreeSize).count == 1);
  REQUIRE(built.city.woods.size() == 2);
  CHECK(built.city.woods[0].top_m == 22.0);
  CHECK(built.city.woods[1].top_m == CityRule{}.wood_height_m);
}

TEST_CASE("on a slope a building stands on the lowest ground under it") {
  const TemporaryFolder folder;
  // 1 m per 100 m to the east, 100 m high at the origin.
  std::ofstream{folder.path() / "slope.asc"}
      << "ncols 3\nnrows 2\nxllcenter -1000\nyllcenter -500\ncellsize 1000\n"
         "90 100 110\n90 100 110\n";
  OsmText osm;
  osm.box(1, -10, -1, -8, 1, house("height", "12"))
      .box(2, 8, -1, 10, 1, {{"building", "yes"}, {"height", "12"}, {"min_height", "2"}})
      .node(1, 0.0005, 0.0, {{"natural", "tree"}});
  ImportOptions options;
  options.terrain = TerrainFile{folder.path() / "slope.asc", TerrainFrame::kLocal};

  const Built built = build(osm, options);

  REQUIRE(built.city.terrain);
  CHECK(built.city.origin.height_m == Approx(100.0));
  const Prism& western = built.building(1).prisms.at(0);
  CHECK(western.bottom_m == Approx(-0.1 * kEast_m).epsilon(1e-4));
  CHECK(western.top_m == Approx(western.bottom_m + 12.0));
  const Prism& eastern = built.building(2).prisms.at(0);
  CHECK(eastern.bottom_m == Approx(0.08 * kEast_m + 2.0).epsilon(1e-4));
  CHECK(eastern.top_m == Approx(0.08 * kEast_m + 12.0).epsilon(1e-4));
  CHECK(built.city.trees.at(0).foot_m.z() == Approx(0.05 * kEast_m).epsilon(1e-4));
  CHECK(built.report.figures.tallest_m == Approx(12.0));
  CHECK(built.report.remarks.empty());
}

TEST_CASE("what lies under the ground is no building") {
  OsmText osm;
  osm.box(1, 0, 0, 1, 1, {{"building", "yes"}})
      .box(2, 2, 0, 3, 1, house("location", "underground"))
      .box(3, 4, 0, 5, 1, house("layer", "-1"));

  const Built built = build(osm);

  CHECK(built.city.buildings.size() == 1);
  CHECK(built.of(Problem::kUnderGround).count == 2);
  // 1e-4 degrees of longitude; those left out reach five times as far.
  CHECK(built.city.north_east_m.x() - built.city.south_west_m.x() == Approx(11.1).margin(0.1));

  OsmText garage;
  garage.box(1, 0, 0, 1, 1, house("location", "underground"));
  CHECK_THROWS_WITH(build(garage), Contains("no building of those mapped stands above the ground"));
}

TEST_CASE("no city is made of nothing, nor of a country") {
  OsmText wood;
  wood.box(1, 0, 0, 1, 1, {{"natural", "wood"}});
  OsmText far_apart;
  far_apart.box(1, 0, 0, 1, 1, {{"building", "yes"}})
      .box(2, 20000, 0, 20001, 1, {{"building", "yes"}});
  ImportOptions elsewhere;
  elsewhere.bounds = GeoBox{5.0, 5.0, 5.1, 5.1};
  const OsmText house_at_zero = OsmText{}.box(1, 0, 0, 1, 1, {{"building", "yes"}});

  CHECK_THROWS_WITH(build(OsmText{}), Contains("no buildings"));
  CHECK_THROWS_WITH(build(wood), Contains("no buildings; the data span 0.0000,0.0000,0.0001"));
  CHECK_THROWS_WITH(build(house_at_zero, elsewhere),
                    Contains("no buildings in 5.0000,5.0000,5.1000,5.1000; the data span"));
  CHECK_THROWS_WITH(build(far_apart), Contains("more than 100 km"));
}

TEST_CASE("two files that overlap make one city, in either order") {
  const TemporaryFolder folder;
  const auto first = folder.path() / "first.osm";
  const auto second = folder.path() / "second.osm";
  std::ofstream{first} << OsmText{}
                              .box(1, 0, 0, 1, 1, {{"building", "yes"}})
                              .box(2, 2, 0, 3, 1, {{"building", "yes"}})
                              .text();
  std::ofstream{second} << OsmText{}
                               .box(2, 2, 0, 3, 1, {{"building", "yes"}})
                               .box(3, 4, 0, 5, 1, {{"building", "yes"}})
                               .text();

  const std::vector forth{first, second};
  const std::vector back{second, first};
  const ImportedCity one = import_city(forth, {});
  const ImportedCity other = import_city(back, {});

  REQUIRE(one.city.buildings.size() == 3);
  REQUIRE(other.city.buildings.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(one.city.buildings[i].osm_id == other.city.buildings[i].osm_id);
    CHECK(one.city.buildings[i].prisms[0].top_m == other.city.buildings[i].prisms[0].top_m);
  }
  CHECK(one.report.files[1].of(Problem::kDuplicate).count == 1);
  CHECK(one.report.files[0].of(Problem::kDuplicate).count == 0);
}

}  // namespace
}  // namespace cuscus::city
