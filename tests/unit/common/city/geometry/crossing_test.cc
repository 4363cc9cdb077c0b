#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

/// 4 m by 2 m and 6 m high, around (10, 0).
Building small_house() { return house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0); }

Crossings crossings(const CityGeometry& geometry, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b) {
  Crossings found;
  geometry.crossings(a, b, found);
  return found;
}

std::uint32_t walls(const CityGeometry& geometry, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b) {
  std::uint32_t sum = 0;
  for (const Crossing& crossing : crossings(geometry, a, b).buildings) {
    sum += crossing.outer_walls;
  }
  return sum;
}

TEST_CASE("a segment through a house goes through two walls, and is inside between them") {
  const CityGeometry geometry{city_of({small_house()})};

  const Crossings found = crossings(geometry, {0.0, 0.5, 3.0}, {20.0, 0.5, 3.0});

  REQUIRE(found.buildings.size() == 1);
  const Crossing& crossing = found.buildings.front();
  CHECK(crossing.building == 0);
  CHECK(crossing.outer_walls == 2);
  CHECK_FALSE(crossing.from_inside);
  CHECK_FALSE(crossing.to_inside);
  REQUIRE(found.of(crossing).size() == 1);
  CHECK(found.of(crossing)[0].begin == Approx(0.4));
  CHECK(found.of(crossing)[0].end == Approx(0.6));
  CHECK(crossing.length_m == Approx(4.0));
  CHECK(geometry.blocked({0.0, 0.5, 3.0}, {20.0, 0.5, 3.0}));
}

TEST_CASE("roofs are walls, and lengths are level and slanted") {
  const CityGeometry geometry{city_of({small_house()})};

  // From 9 m above the ground over the west wall down to 3 m at the east wall: in at the roof.
  const Crossings found = crossings(geometry, {8.0, 0.0, 9.0}, {16.0, 0.0, -3.0});

  REQUIRE(found.buildings.size() == 1);
  CHECK(found.buildings[0].outer_walls == 2);
  CHECK(found.inside[0].begin == Approx(0.25));
  CHECK(found.inside[0].end == Approx(0.5));
  CHECK(found.buildings[0].level_m == Approx(2.0));
  CHECK(found.buildings[0].length_m == Approx(std::hypot(2.0, 3.0)));
}

TEST_CASE("ends inside take a wall away each") {
  const CityGeometry geometry{city_of({small_house()})};
  const Eigen::Vector3d in{10.0, 0.0, 3.0};

  CHECK(walls(geometry, {0.0, 0.0, 3.0}, in) == 1);
  CHECK(walls(geometry, in, {0.0, 0.0, 3.0}) == 1);
  CHECK(walls(geometry, in, {11.0, 0.5, 1.0}) == 0);
  const Crossings found = crossings(geometry, in, {11.0, 0.5, 1.0});
  REQUIRE(found.buildings.size() == 1);
  CHECK(found.buildings[0].from_inside);
  CHECK(found.buildings[0].to_inside);
  CHECK(found.inside[0].begin == 0.0);
  CHECK(found.inside[0].end == 1.0);
  CHECK(geometry.blocked(in, {11.0, 0.5, 1.0}));
}

TEST_CASE("which end is inside follows the direction that was asked for") {
  const CityGeometry geometry{city_of({small_house()})};

  const Crossings found = crossings(geometry, {20.0, 0.0, 3.0}, {10.0, 0.0, 3.0});

  REQUIRE(found.buildings.size() == 1);
  CHECK_FALSE(found.buildings[0].from_inside);
  CHECK(found.buildings[0].to_inside);
  CHECK(found.inside[0].begin == Approx(0.8));
  CHECK(found.inside[0].end == 1.0);
}

TEST_CASE("a courtyard is outdoors") {
  Building block = house(rectangle(0.0, 0.0, 30.0, 30.0), 20.0);
  block.prisms[0].footprint.courtyards.push_back(clockwise(rectangle(10.0, 10.0, 20.0, 20.0)));
  const CityGeometry geometry{city_of({block})};

  const Crossings found = crossings(geometry, {-10.0, 15.0, 5.0}, {40.0, 15.0, 5.0});

  REQUIRE(found.buildings.size() == 1);
  CHECK(found.buildings[0].outer_walls == 4);
  REQUIRE(found.of(found.buildings[0]).size() == 2);
  CHECK(found.inside[0].end == Approx(0.4));
  CHECK(found.inside[1].begin == Approx(0.6));
  CHECK(walls(geometry, {15.0, 15.0, 5.0}, {40.0, 15.0, 5.0}) == 2);
  CHECK_FALSE(geometry.inside(Eigen::Vector3d{15.0, 15.0, 5.0}));
  CHECK_FALSE(geometry.blocked({11.0, 11.0, 1.0}, {19.0, 19.0, 19.0}));
}

TEST_CASE("below a bridge the way is free") {
  const CityGeometry geometry{city_of({house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0, 4.0)})};

  CHECK_FALSE(geometry.blocked({0.0, 0.0, 2.0}, {20.0, 0.0, 2.0}));
  CHECK(walls(geometry, {0.0, 0.0, 5.0}, {20.0, 0.0, 5.0}) == 2);
  CHECK(walls(geometry, {10.0, 0.0, 2.0}, {10.0, 0.0, 9.0}) == 2);
}

TEST_CASE("what stands on the ground has no way beneath it") {
  const CityGeometry geometry{city_of({small_house()})};

  CHECK(walls(geometry, {0.0, 0.0, 0.0}, {20.0, 0.0, 0.0}) == 2);
  CHECK(walls(geometry, {0.0, 0.0, -0.2}, {20.0, 0.0, -0.2}) == 2);
}

TEST_CASE("where prisms of one building meet is no wall; where buildings meet are two") {
  const Building west = house(rectangle(0.0, 0.0, 10.0, 10.0), 12.0);
  const Building east = house(rectangle(10.0, 0.0, 20.0, 10.0), 12.0);
  const Building tower = house(rectangle(0.0, 0.0, 10.0, 10.0), 40.0, 12.0);
  const Building both = building({west.prisms[0], east.prisms[0], tower.prisms[0]});

  CHECK(walls(CityGeometry{city_of({both})}, {-5.0, 5.0, 3.0}, {25.0, 5.0, 3.0}) == 2);
  CHECK(walls(CityGeometry{city_of({west, east})}, {-5.0, 5.0, 3.0}, {25.0, 5.0, 3.0}) == 4);
  // Up through the storeys; and along the floor between them, which is neither's outside.
  CHECK(walls(CityGeometry{city_of({both})}, {5.0, 5.0, 3.0}, {5.0, 5.0, 50.0}) == 1);
  CHECK(walls(CityGeometry{city_of({both})}, {-5.0, 5.0, 12.0}, {8.0, 5.0, 12.0}) == 1);
}

TEST_CASE("a gap of a millimetre between prisms of one building is no way out") {
  Building both = building({house(rectangle(0.0, 0.0, 10.0, 10.0), 12.0).prisms[0],
                            house(rectangle(10.0005, 0.0, 20.0, 10.0), 12.0).prisms[0]});

  CHECK(walls(CityGeometry{city_of({both})}, {-5.0, 5.0, 3.0}, {25.0, 5.0, 3.0}) == 2);
  both.prisms[1].footprint.outer = rectangle(10.01, 0.0, 20.0, 10.0);
  CHECK(walls(CityGeometry{city_of({both})}, {-5.0, 5.0, 3.0}, {25.0, 5.0, 3.0}) == 4);
}

TEST_CASE("a ray along a wall that two buildings share is in exactly one of them") {
  const CityGeometry geometry{city_of({house(rectangle(0.0, 0.0, 10.0, 10.0), 12.0),
                                       house(rectangle(0.0, 10.0, 10.0, 20.0), 12.0)})};
  const Eigen::Vector3d a{-5.0, 10.0, 3.0};
  const Eigen::Vector3d b{15.0, 10.0, 3.0};

  CHECK(walls(geometry, a, b) == 2);
  CHECK(walls(geometry, b, a) == 2);
  // To the left of the ray from west to east is the northern one.
  CHECK(crossings(geometry, a, b).buildings[0].building == 1);
  CHECK(crossings(geometry, b, a).buildings[0].building == 1);
  // Through a corner that both have, on into one of them.
  CHECK(walls(geometry, {-5.0, 15.0, 3.0}, {15.0, -5.0, 3.0}) == 2);
}

TEST_CASE("what only touches a roof or a corner, or ends on a wall, has gone through nothing") {
  const CityGeometry geometry{city_of({small_house()})};

  CHECK(walls(geometry, {0.0, 0.0, 6.0}, {20.0, 0.0, 6.0}) == 0);
  CHECK(walls(geometry, {0.0, 0.0, 3.0}, {8.0, 0.0, 3.0}) == 0);
  CHECK(walls(geometry, {8.0, 0.0, 3.0}, {0.0, 0.0, 3.0}) == 0);
  CHECK(walls(geometry, {10.0, 0.0, 9.0}, {10.0, 0.0, 6.0}) == 0);
  // From a wall inwards it has.
  CHECK(walls(geometry, {8.0, 0.0, 3.0}, {10.0, 0.0, 3.0}) == 1);
  CHECK(walls(geometry, {8.0, 0.0, 3.0}, {20.0, 0.0, 3.0}) == 2);
}

TEST_CASE("upright segments and segments of no length are answered like any other") {
  const CityGeometry geometry{city_of({small_house()})};

  CHECK(walls(geometry, {10.0, 0.0, 1.0}, {10.0, 0.0, 9.0}) == 1);
  CHECK(walls(geometry, {10.0, 2.0, 1.0}, {10.0, 2.0, 9.0}) == 0);
  const Crossings in = crossings(geometry, {10.0, 0.0, 1.0}, {10.0, 0.0, 1.0});
  REQUIRE(in.buildings.size() == 1);
  CHECK(in.buildings[0].outer_walls == 0);
  CHECK(in.buildings[0].from_inside);
  CHECK(in.buildings[0].to_inside);
  CHECK(in.buildings[0].length_m == 0.0);
  CHECK(crossings(geometry, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}).buildings.empty());
}

TEST_CASE("a city without buildings is in nobody's way") {
  const CityGeometry geometry{City{}};

  CHECK_FALSE(geometry.blocked({0.0, 0.0, 1.0}, {1e5, 0.0, 1.0}));
  CHECK(crossings(geometry, {0.0, 0.0, 1.0}, {1e5, 0.0, 1.0}).buildings.empty());
  CHECK_FALSE(geometry.inside(Eigen::Vector3d{0.0, 0.0, 1.0}));
}

TEST_CASE("inner walls are counted by the rooms along the longest wall") {
  // 20 m by 10 m in rooms of 4 m: walls 4, 8, 12, 16 m from the west one.
  City city = city_of({house(rectangle(0.0, 0.0, 20.0, 10.0), 6.0)});
  city.buildings[0].room_m = 4.0;
  const CityGeometry geometry{city};

  const Crossings found = crossings(geometry, {-5.0, 5.0, 3.0}, {25.0, 5.0, 3.0});

  REQUIRE(found.buildings.size() == 1);
  CHECK(found.buildings[0].inner_walls == 4);
  CHECK(found.buildings[0].mean_inner_walls == Approx(5.0));
}

TEST_CASE("near gives those within the margin, however far it reaches") {
  const CityGeometry geometry{
      city_of({house(rectangle(10.0, 5.0, 20.0, 15.0), 12.0),
               house(rectangle(10.0, 40.0, 20.0, 50.0), 12.0), small_house()})};
  std::vector<std::uint32_t> found;

  geometry.near({0.0, 0.0, 3.0}, {30.0, 0.0, 3.0}, 0.5, found);
  CHECK(found == std::vector<std::uint32_t>{2});
  geometry.near({0.0, 0.0, 3.0}, {30.0, 0.0, 3.0}, 5.0, found);
  CHECK(found == std::vector<std::uint32_t>{0, 2});
  geometry.near({0.0, 0.0, 3.0}, {30.0, 0.0, 3.0}, 40.0, found);
  CHECK(found == std::vector<std::uint32_t>{0, 1, 2});
}

TEST_CASE("coordinates that are not finite are refused, and so are negative reaches") {
  const CityGeometry geometry{city_of({small_house()})};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d good{0.0, 0.0, 1.0};
  const Eigen::Vector3d bad{0.0, nan, 1.0};
  Crossings found;
  std::vector<std::uint32_t> buildings;

  CHECK_THROWS_AS(geometry.crossings(good, bad, found), std::invalid_argument);
  CHECK_THROWS_AS(geometry.blocked(bad, good), std::invalid_argument);
  CHECK_THROWS_AS(geometry.near(good, good, nan, buildings), std::invalid_argument);
  CHECK_THROWS_AS(geometry.first_hit(bad, good, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(geometry.first_hit(good, Eigen::Vector3d::Zero(), 1.0), std::invalid_argument);
  CHECK_THROWS_AS(geometry.first_hit(good, good, nan), std::invalid_argument);
  CHECK_THROWS_AS(geometry.nearest(good, -1.0), std::invalid_argument);
  CHECK_THROWS_AS(geometry.sweep(good, bad, 0.3), std::invalid_argument);
  CHECK_THROWS_AS(geometry.inside(bad), std::invalid_argument);
  CHECK_THROWS_AS(geometry.ground_m({nan, 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(geometry.foliage_m(good, bad), std::invalid_argument);
}

TEST_CASE("a city of which no geometry can be made is refused, with the body's name") {
  using Catch::Matchers::Contains;
  const auto refusal = [](const City& city) -> std::string {
    try {
      const CityGeometry geometry{city};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  City city = city_of({small_house()});

  city.buildings[0].prisms[0].top_m = 0.0;
  CHECK_THAT(refusal(city), Contains("building 7") && Contains("tops"));
  city = city_of({house(clockwise(rectangle(0.0, 0.0, 1.0, 1.0)), 3.0)});
  CHECK_THAT(refusal(city), Contains("building 7") && Contains("counter-clockwise"));
  city = city_of({house({{0.0, 0.0}, {1.0, 0.0}}, 3.0)});
  CHECK_THAT(refusal(city), Contains("3 corners"));
  city = city_of({building({})});
  CHECK_THAT(refusal(city), Contains("must have a prism"));
  city = City{};
  city.trees.push_back({.foot_m = {0.0, 0.0, 0.0}, .height_m = 5.0, .crown_radius_m = 0.0});
  CHECK_THAT(refusal(city), Contains("tree 0") && Contains("crown"));
  city = City{};
  city.terrain = Terrain{.columns = 2, .rows = 2, .height_m = {1.0F}};
  CHECK_THAT(refusal(city), Contains("terrain") && Contains("rows times columns"));
}

}  // namespace
}  // namespace cuscus::city
