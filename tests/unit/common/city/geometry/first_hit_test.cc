#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

City house_and_garden() {
  City city = city_of({house(rectangle(10.0, -5.0, 20.0, 5.0), 6.0)});
  city.trees.push_back({.foot_m = {0.0, 30.0, 0.0}, .height_m = 9.0, .crown_radius_m = 2.0});
  city.woods.push_back(
      {.footprint = {.outer = rectangle(-50.0, -50.0, -30.0, -30.0), .courtyards = {}},
       .bottom_m = 0.0,
       .top_m = 12.0});
  return city;
}

TEST_CASE("the first hit is at the wall, with the wall's normal") {
  const CityGeometry geometry{house_and_garden()};

  const auto hit = geometry.first_hit({0.0, 0.0, 3.0}, {2.0, 0.0, 0.0}, 100.0);

  REQUIRE(hit);
  CHECK(hit->distance_m == Approx(10.0));
  CHECK(hit->normal.isApprox(-Eigen::Vector3d::UnitX()));
  CHECK(hit->body == Body::kBuilding);
  CHECK(hit->index == 0);
  CHECK_FALSE(geometry.first_hit({0.0, 0.0, 3.0}, {1.0, 0.0, 0.0}, 9.9));
  CHECK_FALSE(geometry.first_hit({0.0, 0.0, 3.0}, {-1.0, 0.0, 0.0}, kInfinite));
}

TEST_CASE("roofs face up, undersides down, and the ground up") {
  const CityGeometry geometry{city_of({house(rectangle(10.0, -5.0, 20.0, 5.0), 6.0, 4.0)})};

  const auto roof = geometry.first_hit({15.0, 0.0, 9.0}, {0.0, 0.0, -1.0}, kInfinite);
  const auto underside = geometry.first_hit({15.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, kInfinite);
  const auto ground = geometry.first_hit({0.0, 0.0, 3.0}, {3.0, 4.0, -5.0}, kInfinite);

  REQUIRE(roof);
  CHECK(roof->distance_m == Approx(3.0));
  CHECK(roof->normal.isApprox(Eigen::Vector3d::UnitZ()));
  REQUIRE(underside);
  CHECK(underside->distance_m == Approx(3.0));
  CHECK(underside->normal.isApprox(-Eigen::Vector3d::UnitZ()));
  REQUIRE(ground);
  CHECK(ground->body == Body::kGround);
  CHECK(ground->distance_m == Approx(3.0 * std::sqrt(2.0)));
  CHECK(ground->normal.isApprox(Eigen::Vector3d::UnitZ()));
}

TEST_CASE("a ray from inside a solid or from below the ground is stopped at once") {
  const CityGeometry geometry{house_and_garden()};

  const auto in_house = geometry.first_hit({15.0, 0.0, 3.0}, {1.0, 0.0, 0.0}, 100.0);
  const auto buried = geometry.first_hit({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 100.0);

  REQUIRE(in_house);
  CHECK(in_house->distance_m == 0.0);
  CHECK(in_house->body == Body::kBuilding);
  CHECK(in_house->normal.isApprox(-Eigen::Vector3d::UnitX()));
  REQUIRE(buried);
  CHECK(buried->distance_m == 0.0);
  CHECK(buried->body == Body::kGround);
}

TEST_CASE("crowns, trunks and woods stop rays") {
  const CityGeometry geometry{house_and_garden()};

  // The crown is from 3 to 9 m: balls of 2 m at 5 and 7 m, and what is between. The trunk has 0.2
  // m.
  const auto crown = geometry.first_hit({0.0, 0.0, 6.0}, {0.0, 1.0, 0.0}, 100.0);
  const auto trunk = geometry.first_hit({0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, 100.0);
  const auto top = geometry.first_hit({0.0, 30.0, 20.0}, {0.0, 0.0, -1.0}, 100.0);
  const auto wood = geometry.first_hit({-40.0, 0.0, 5.0}, {0.0, -1.0, 0.0}, 100.0);

  REQUIRE(crown);
  CHECK(crown->distance_m == Approx(28.0));
  CHECK(crown->body == Body::kTree);
  CHECK(crown->normal.isApprox(-Eigen::Vector3d::UnitY()));
  REQUIRE(trunk);
  CHECK(trunk->distance_m == Approx(29.8));
  REQUIRE(top);
  CHECK(top->distance_m == Approx(11.0));
  CHECK(top->normal.isApprox(Eigen::Vector3d::UnitZ()));
  REQUIRE(wood);
  CHECK(wood->distance_m == Approx(30.0));
  CHECK(wood->body == Body::kWood);
}

TEST_CASE("free height is up to the next underside, and down to the next roof, crown or ground") {
  City city = house_and_garden();
  city.buildings.push_back(house(rectangle(100.0, -5.0, 110.0, 5.0), 6.0, 4.0));
  const CityGeometry geometry{city};

  CHECK(geometry.free_above_m({105.0, 0.0, 1.0}) == Approx(3.0));
  CHECK(geometry.free_above_m({0.0, 0.0, 1.0}) == kInfinite);
  CHECK(geometry.free_above_m({15.0, 0.0, 1.0}) == 0.0);
  CHECK(geometry.free_below_m({105.0, 0.0, 1.0}) == Approx(1.0));
  CHECK(geometry.free_below_m({105.0, 0.0, 10.0}) == Approx(4.0));
  CHECK(geometry.free_below_m({0.0, 30.0, 10.0}) == Approx(1.0));
  CHECK(geometry.free_below_m({0.0, 0.0, 10.0}) == Approx(10.0));
}

TEST_CASE("ranges around are first hits, and infinite where there is none") {
  const CityGeometry geometry{house_and_garden()};
  const std::array<Eigen::Vector3d, 3> directions{
      Eigen::Vector3d::UnitX(), Eigen::Vector3d{-1.0, 0.0, 0.0}, Eigen::Vector3d{0.0, 0.0, -1.0}};
  std::array<double, 3> distances_m{};

  geometry.ranges({0.0, 0.0, 3.0}, directions, 50.0, distances_m);

  CHECK(distances_m[0] == Approx(10.0));
  CHECK(distances_m[1] == kInfinite);
  CHECK(distances_m[2] == Approx(3.0));
}

TEST_CASE("the first hit is where the earliest crossing begins") {
  const City city = town_of_stars(31);
  const CityGeometry geometry{city};
  Draws draws{random::CounterStream{32, 33}};

  int hits = 0;
  Crossings found;
  for (int i = 0; i < 5000 / kOneIn; ++i) {
    const Eigen::Vector3d a = draws.place({0.0, 0.0, 0.5}, {300.0, 300.0, 45.0});
    const Eigen::Vector3d b = draws.place({0.0, 0.0, 0.5}, {300.0, 300.0, 45.0});
    geometry.crossings(a, b, found);
    double first = kInfinite;
    std::uint32_t building = 0;
    for (const Crossing& crossing : found.buildings) {
      if (found.of(crossing)[0].begin < first) {
        first = found.of(crossing)[0].begin;
        building = crossing.building;
      }
    }
    const double length_m = (b - a).norm();
    const auto hit = geometry.first_hit(a, b - a, length_m);

    REQUIRE(hit.has_value() == (first < kInfinite));
    if (hit) {
      CHECK(hit->distance_m == Approx(first * length_m).margin(1e-8));
      CHECK(hit->index == building);
      CHECK(hit->normal.norm() == Approx(1.0));
      CHECK(hit->normal.dot(b - a) < 0.0);
      // The normal leads out: beside the surface on one side it is free, on the other not.
      const Eigen::Vector3d at = a + hit->distance_m * (b - a).normalized();
      if (hit->distance_m > 0.0) {
        CHECK_FALSE(geometry.inside(at + 1e-6 * hit->normal));
        CHECK(geometry.inside(at - 1e-6 * hit->normal) == building);
        ++hits;
      }
    }
  }
  CHECK(hits > 1000 / kOneIn);
}

TEST_CASE("foliage is crossed in crowns and woods, and counted once where they overlap") {
  City city = house_and_garden();
  const CityGeometry geometry{city};

  CHECK(geometry.foliage_m({0.0, 0.0, 6.0}, {0.0, 60.0, 6.0}) == Approx(4.0));
  // Through the upper ball, 1 m above its centre: 2 sqrt(2² - 1²).
  CHECK(geometry.foliage_m({0.0, 0.0, 8.0}, {0.0, 60.0, 8.0}) == Approx(2.0 * std::sqrt(3.0)));
  CHECK(geometry.foliage_m({0.0, 0.0, 1.0}, {0.0, 60.0, 1.0}) == 0.0);  // beneath the crown
  CHECK(geometry.foliage_m({-40.0, 0.0, 5.0}, {-40.0, -60.0, 5.0}) == Approx(20.0));
  CHECK(geometry.foliage_m({-40.0, -40.0, 5.0}, {-40.0, -60.0, 5.0}) == Approx(10.0));
  CHECK_FALSE(geometry.blocked({-40.0, 0.0, 5.0}, {-40.0, -60.0, 5.0}));

  city.trees.push_back({.foot_m = {0.0, 31.0, 0.0}, .height_m = 9.0, .crown_radius_m = 2.0});
  CHECK(CityGeometry{city}.foliage_m({0.0, 0.0, 6.0}, {0.0, 60.0, 6.0}) == Approx(5.0));
}

}  // namespace
}  // namespace cuscus::city
