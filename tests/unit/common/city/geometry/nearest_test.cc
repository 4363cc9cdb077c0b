#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

TEST_CASE("the nearest surface of a house is its wall, roof, edge or corner") {
  const CityGeometry geometry{city_of({house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0)})};
  struct Row {
    Eigen::Vector3d p;
    double distance_m;
    Eigen::Vector3d normal;
  };
  const auto row = GENERATE(
      Row{{5.0, 0.5, 4.0}, 3.0, {-1.0, 0.0, 0.0}}, Row{{10.0, 0.0, 8.0}, 2.0, {0.0, 0.0, 1.0}},
      Row{{15.0, 5.0, 5.5}, 5.0, {0.6, 0.8, 0.0}},                    // an upright edge
      Row{{14.0, 2.0, 8.0}, 3.0, {2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0}},  // a corner
      Row{{10.0, 0.0, 5.5}, -0.5, {0.0, 0.0, 1.0}},                   // beneath the roof
      Row{{11.75, 0.5, 3.0}, -0.25, {1.0, 0.0, 0.0}});                // behind the east wall

  const auto surface = geometry.nearest(row.p, 10.0);

  REQUIRE(surface);
  CHECK(surface->distance_m == Approx(row.distance_m));
  CHECK(surface->normal.isApprox(row.normal));
  CHECK(surface->p_WS.isApprox(row.p - row.distance_m * row.normal));
  CHECK(surface->body == Body::kBuilding);
}

TEST_CASE("a point on a wall is at distance 0, and its normal leads out") {
  const CityGeometry geometry{city_of({house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0)})};

  const auto surface = geometry.nearest({8.0, 0.0, 3.0}, 1.0);

  REQUIRE(surface);
  CHECK(surface->distance_m == 0.0);
  CHECK(surface->normal.isApprox(-Eigen::Vector3d::UnitX()));
}

TEST_CASE("what is further than the radius is not there") {
  const CityGeometry geometry{city_of({house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0)})};

  CHECK_FALSE(geometry.nearest({0.0, 0.0, 9.0}, 5.0));
  const auto ground = geometry.nearest({0.0, 0.0, 4.0}, 5.0);
  REQUIRE(ground);
  CHECK(ground->body == Body::kGround);
  CHECK(ground->distance_m == 4.0);
  const auto buried = geometry.nearest({0.0, 0.0, -30.0}, 5.0);
  REQUIRE(buried);
  CHECK(buried->distance_m == -30.0);
}

TEST_CASE("every body within the radius has its own nearest surface") {
  City city = city_of(
      {house(rectangle(3.0, -5.0, 8.0, 5.0), 9.0), house(rectangle(-8.0, -5.0, -4.0, 5.0), 9.0)});
  city.trees.push_back({.foot_m = {0.0, 6.0, 0.0}, .height_m = 9.0, .crown_radius_m = 2.0});
  city.woods.push_back({.footprint = {.outer = rectangle(-1.0, -9.0, 1.0, -5.0), .courtyards = {}},
                        .bottom_m = 0.0,
                        .top_m = 12.0});
  const CityGeometry geometry{city};
  std::vector<Surface> surfaces;

  geometry.surfaces({0.0, 0.0, 6.0}, 10.0, surfaces);

  REQUIRE(surfaces.size() == 5);
  CHECK(surfaces[0].distance_m == Approx(3.0));
  CHECK(surfaces[1].distance_m == Approx(4.0));
  CHECK(surfaces[1].index == 1);
  CHECK(surfaces[2].body == Body::kGround);
  CHECK(surfaces[2].distance_m == Approx(6.0));
  CHECK(surfaces[3].body == Body::kTree);
  CHECK(surfaces[3].distance_m == Approx(4.0));
  CHECK(surfaces[4].body == Body::kWood);
  CHECK(surfaces[4].distance_m == Approx(5.0));
  CHECK(surfaces[4].normal.isApprox(Eigen::Vector3d::UnitY()));
}

TEST_CASE("from inside a building of several prisms the way out leads through no inner face") {
  // Two halves and a storey on one: the nearest face is the one between the halves, which is none.
  const CityGeometry geometry{
      city_of({building({house(rectangle(0.0, 0.0, 10.0, 20.0), 12.0).prisms[0],
                         house(rectangle(10.0, 0.0, 20.0, 20.0), 12.0).prisms[0],
                         house(rectangle(0.0, 0.0, 10.0, 20.0), 18.0, 12.0).prisms[0]})})};

  const auto by_the_seam = geometry.nearest({9.0, 10.0, 6.0}, 1.0);
  const auto below_the_storey = geometry.nearest({5.0, 10.0, 11.5}, 1.0);

  REQUIRE(by_the_seam);
  CHECK(by_the_seam->distance_m == Approx(-std::hypot(1.0, 6.0)));  // the eastern roof's rim
  REQUIRE(below_the_storey);
  CHECK(below_the_storey->distance_m == Approx(-5.0));
  CHECK(geometry.inside(Eigen::Vector3d{10.0, 10.0, 6.0}) == 0);
}

}  // namespace
}  // namespace cuscus::city
