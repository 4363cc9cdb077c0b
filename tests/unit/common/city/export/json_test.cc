#include "common/city/export/json.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/unit/common/city/export/sample_city.h"

namespace cuscus::city {

TEST_CASE("A map as JSON has everything that the city has") {
  const auto map = nlohmann::json::parse(
      json_text(sample_city(), {.title = "Sample", .attribution = "made up"}));

  REQUIRE(map.at("format") == "cuscus-map");
  REQUIRE(map.at("version") == 1);
  REQUIRE(map.at("title") == "Sample");
  REQUIRE(map.at("attribution") == "made up");
  REQUIRE(map.at("origin").at("latitude_deg") == 44.5);
  REQUIRE(map.at("origin").at("height_m") == 54.0);
  REQUIRE(map.at("north_east_m") == nlohmann::json::array({100.0, 50.0}));
  const auto& palace = map.at("buildings").at(0);
  REQUIRE(palace.at("osm_id") == -7);
  REQUIRE(palace.at("name") == "Palazzo <A> & \"B\"");
  REQUIRE(palace.at("outer_walls") == "stone");
  REQUIRE(palace.at("room_m") == 5.0);
  REQUIRE(palace.at("height_source") == "tag");
  REQUIRE(palace.at("prisms").at(0).at("top_m") == 12.5);
  REQUIRE(palace.at("prisms").at(0).at("outer").size() == 4);
  REQUIRE(palace.at("prisms").at(0).at("courtyards").at(0).at(1) ==
          nlohmann::json::array({-80.0, -10.0}));
  REQUIRE(map.at("buildings").at(1).at("prisms").at(1).at("bottom_m") == 20.0);
  REQUIRE(map.at("streets").at(0).at("axis_m").size() == 3);
  REQUIRE(map.at("streets").at(0).at("width_m") == 8.0);
  REQUIRE(map.at("trees").at(0).at("crown_radius_m") == 2.5);
  REQUIRE(map.at("woods").at(0).at("top_m") == 11.0);
  REQUIRE(map.at("terrain").is_null());
}

TEST_CASE("Metres in a map have three decimals at most, and no negative zero") {
  City city;
  city.trees.push_back({.foot_m = {-0.0001, 1.0 / 3.0, 0.0}, .height_m = 5.0});

  const std::string text = json_text(city, {});

  REQUIRE_THAT(text, Catch::Contains("\"foot_m\":[0,0.333,0]"));
}

TEST_CASE("Bytes in a name that are not UTF-8 do not spoil the map") {
  City city;
  city.streets.push_back({.osm_id = 1, .name = "caf\xE9", .axis_m = {}, .width_m = 1.0});

  const auto map = nlohmann::json::parse(json_text(city, {}));

  REQUIRE(map.at("streets").at(0).at("name") == "caf\xEF\xBF\xBD");  // U+FFFD
}

TEST_CASE("A map has the terrain by rows from the south-west") {
  City city;
  city.terrain = Terrain{.south_west_m = {-5.0, -5.0},
                         .cell_m = 10.0,
                         .columns = 2,
                         .rows = 1,
                         .height_m = {1.5F, 2.5F}};

  const auto map = nlohmann::json::parse(json_text(city, {}));

  REQUIRE(map.at("terrain").at("columns") == 2);
  REQUIRE(map.at("terrain").at("height_m") == nlohmann::json::array({1.5, 2.5}));
}

}  // namespace cuscus::city
