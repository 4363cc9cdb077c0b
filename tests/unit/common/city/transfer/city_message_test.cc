#include "common/city/transfer/city_message.h"

#include <catch2/catch.hpp>
#include <span>
#include <stdexcept>
#include <string>

namespace cuscus::city {
namespace {

const Ring kSquare{{0, 0}, {20, 0}, {20, 20}, {0, 20}};
const Ring kCourtyard{{5, 5}, {5, 15}, {15, 15}, {15, 5}};

City full_city() {
  City city;
  city.attribution = "© OpenStreetMap contributors";
  city.origin = {.latitude_deg = 44.4949, .longitude_deg = 11.3426, .height_m = 54.0};
  city.south_west_m = {-300.0, -200.0};
  city.north_east_m = {300.0, 200.0};
  city.buildings.push_back(
      {.osm_id = -17,
       .name = "Palazzo d'Accursio",
       .prisms = {{{kSquare, {kCourtyard}}, 0.0, 21.5}, {{kCourtyard, {}}, 3.0, 44.0}},
       .outer_walls = Material::kStone,
       .room_m = 4.0,
       .height_source = HeightSource::kTag});
  city.streets.push_back(
      {.osm_id = 4, .name = "Via dell'Archiginnasio", .axis_m = {{0, -5}, {40, -5}}, .width_m = 7});
  city.trees.push_back({.foot_m = {30, 30, 1}, .height_m = 9, .crown_radius_m = 3});
  city.woods.push_back({.footprint = {kSquare, {}}, .bottom_m = 1, .top_m = 15});
  city.terrain = Terrain{
      .south_west_m = {-1, -2}, .cell_m = 5, .columns = 2, .rows = 1, .height_m = {0.5F, 1.5F}};
  return city;
}

void check_equal(const Footprint& a, const Footprint& b) {
  CHECK(a.outer == b.outer);
  CHECK(a.courtyards == b.courtyards);
}

TEST_CASE("A city arrives as it was sent") {
  const City sent = full_city();
  const std::string bytes = to_message(sent).SerializeAsString();

  const City got = from_bytes(std::as_bytes(std::span{bytes}));

  CHECK(got.attribution == sent.attribution);
  CHECK(got.origin.latitude_deg == sent.origin.latitude_deg);
  CHECK(got.origin.longitude_deg == sent.origin.longitude_deg);
  CHECK(got.origin.height_m == sent.origin.height_m);
  CHECK(got.south_west_m == sent.south_west_m);
  CHECK(got.north_east_m == sent.north_east_m);
  REQUIRE(got.buildings.size() == 1);
  const Building& a = got.buildings[0];
  const Building& b = sent.buildings[0];
  CHECK(a.osm_id == b.osm_id);
  CHECK(a.name == b.name);
  CHECK(a.outer_walls == b.outer_walls);
  CHECK(a.room_m == b.room_m);
  CHECK(a.height_source == b.height_source);
  REQUIRE(a.prisms.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    check_equal(a.prisms[i].footprint, b.prisms[i].footprint);
    CHECK(a.prisms[i].bottom_m == b.prisms[i].bottom_m);
    CHECK(a.prisms[i].top_m == b.prisms[i].top_m);
  }
  REQUIRE(got.streets.size() == 1);
  CHECK(got.streets[0].osm_id == 4);
  CHECK(got.streets[0].name == sent.streets[0].name);
  CHECK(got.streets[0].axis_m == sent.streets[0].axis_m);
  CHECK(got.streets[0].width_m == 7);
  REQUIRE(got.trees.size() == 1);
  CHECK(got.trees[0].foot_m == sent.trees[0].foot_m);
  CHECK(got.trees[0].height_m == 9);
  CHECK(got.trees[0].crown_radius_m == 3);
  REQUIRE(got.woods.size() == 1);
  check_equal(got.woods[0].footprint, sent.woods[0].footprint);
  CHECK(got.woods[0].bottom_m == 1);
  CHECK(got.woods[0].top_m == 15);
  REQUIRE(got.terrain);
  CHECK(got.terrain->south_west_m == sent.terrain->south_west_m);
  CHECK(got.terrain->cell_m == 5);
  CHECK(got.terrain->columns == 2);
  CHECK(got.terrain->rows == 1);
  CHECK(got.terrain->height_m == sent.terrain->height_m);
}

TEST_CASE("Bytes that are no message are refused") {
  const std::string bytes = to_message(full_city()).SerializeAsString();
  CHECK_THROWS_AS(from_bytes(std::as_bytes(std::span{bytes}.first(bytes.size() - 1))),
                  std::invalid_argument);
}

TEST_CASE("A message that nobody sends is refused") {
  proto::CityModel message = to_message(full_city());
  SECTION("half a corner") {
    message.mutable_buildings(0)
        ->mutable_prisms(0)
        ->mutable_footprint()
        ->mutable_rings(0)
        ->add_corners_m(1.0);
  }
  SECTION("no ring") { message.mutable_woods(0)->mutable_footprint()->clear_rings(); }
  SECTION("a material that there is not") { message.mutable_buildings(0)->set_outer_walls(99); }
  SECTION("a source that there is not") { message.mutable_buildings(0)->set_height_source(3); }
  SECTION("a grid with holes") { message.mutable_terrain()->set_rows(2); }
  CHECK_THROWS_AS(from_message(message), std::invalid_argument);
}

}  // namespace
}  // namespace cuscus::city
