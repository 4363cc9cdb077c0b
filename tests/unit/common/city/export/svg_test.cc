#include "common/city/export/svg.h"

#include <catch2/catch.hpp>
#include <string_view>

#include "common/city/export/height_classes.h"
#include "common/city/export/map_format.h"
#include "common/city/export/street_labels.h"
#include "tests/unit/common/city/export/sample_city.h"

namespace cuscus::city {
namespace {

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

City city_of_heights(const std::vector<double>& heights_m) {
  City city;
  for (const double height_m : heights_m) {
    Building building;
    building.prisms.push_back({{square_ring(0.0, 0.0, 1.0), {}}, 0.0, height_m});
    city.buildings.push_back(building);
  }
  return city;
}

}  // namespace

TEST_CASE("A map shows prisms, streets with names, trees, woods and who made the data") {
  const std::string svg =
      svg_text(sample_city(), {.title = "A <sample>", .attribution = kOsmAttribution});

  // 200 m are 1000 units: the palace's south-western corner is 10 m east and 90 m south of the
  // north-western one; the courtyard is a second ring of the same path.
  REQUIRE_THAT(svg, Catch::Contains("M50.00 450.00L250.00 450.00"));
  REQUIRE_THAT(svg, Catch::Contains("ZM100.00 400.00"));
  REQUIRE_THAT(svg, Catch::Contains("stroke-width=\"40.00\""));  // the street of 8 m
  REQUIRE_THAT(svg, Catch::Contains(">Via &amp; Vicolo</text>"));
  REQUIRE_THAT(svg, Catch::Contains("A &lt;sample&gt;"));
  REQUIRE_THAT(svg, Catch::Contains("© OpenStreetMap contributors"));
  REQUIRE_THAT(svg, Catch::Contains(">20 m</text>"));  // a scale of about a twelfth of 200 m
  REQUIRE(count_of(svg, "<circle transform") == 1);
  REQUIRE(count_of(svg, "<g") == count_of(svg, "</g>"));
}

TEST_CASE("An empty city is an empty map") {
  REQUIRE_THAT(svg_text(City{}, {}), Catch::EndsWith("</svg>\n"));
}

TEST_CASE("Classes of heights have round bounds and every height a class") {
  const HeightClasses classes{city_of_heights({10.2, 11.0, 12.4, 13.9, 14.8})};

  // 4.6 m in seven classes are 0.66 m: steps of 1 m. The highest counts for less than a fiftieth.
  REQUIRE(classes.label(0) == "below 11 m");
  REQUIRE(classes.label(1) == "11 - 12 m");
  REQUIRE(classes.label(classes.count() - 1) == "13 m and more");
  REQUIRE(classes.class_of(10.2) == 0);
  REQUIRE(classes.class_of(11.0) == 1);
  REQUIRE(classes.class_of(400.0) == classes.count() - 1);
  REQUIRE(HeightClasses{city_of_heights({})}.label(0) == "all buildings");
}

TEST_CASE("Steps are 1, 2 or 5 times a power of ten") {
  REQUIRE(round_step(0.7) == Approx(1.0));
  REQUIRE(round_step(1.1) == Approx(2.0));
  REQUIRE(round_step(30.0) == Approx(50.0));
  REQUIRE(round_step(100.0) == Approx(100.0));
  REQUIRE(round_step(60.0) == Approx(100.0));
}

TEST_CASE("A street's name is there only where it fits, once, and never upside down") {
  City city;
  city.north_east_m = {1000.0, 1000.0};
  // 11 letters of 12 units need 74 units.
  city.streets.push_back({1, "Long Street", {{500.0, 500.0}, {300.0, 500.0}}, 20.0});
  city.streets.push_back({2, "Long Street", {{500.0, 520.0}, {300.0, 520.0}}, 20.0});
  city.streets.push_back({3, "Short Alley", {{100.0, 100.0}, {160.0, 100.0}}, 20.0});
  city.streets.push_back({4, "Crossing It", {{400.0, 400.0}, {400.0, 600.0}}, 20.0});
  city.streets.push_back({5, "", {{0.0, 900.0}, {900.0, 900.0}}, 20.0});

  const auto labels = street_labels(city, 1.0);

  REQUIRE(labels.size() == 1);
  REQUIRE(labels[0].name == "Long Street");
  REQUIRE(labels[0].middle == Eigen::Vector2d{400.0, 500.0});
  REQUIRE(std::abs(labels[0].angle_deg) < 90.0);
}

TEST_CASE("The ending of a file's name says what map it is") {
  REQUIRE(map_format_of("a/b.json") == MapFormat::kJson);
  REQUIRE(map_format_of("map.svg") == MapFormat::kSvg);
  REQUIRE(map_format_of("map.glb") == MapFormat::kGlb);
  REQUIRE_FALSE(map_format_of("map.png").has_value());
}

}  // namespace cuscus::city
