#include "common/geometry/upright_box.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace cuscus {
namespace {

UprightBox house() { return UprightBox{{.centre_m = {10.0, 0.0}, .size_m = {4.0, 2.0, 6.0}}}; }

TEST_CASE("a segment through a box is inside between its walls") {
  const auto inside = house().crossing(house().in_box({0.0, 0.5, 3.0}), {10.0, 0.5, 3.0});

  // From x = -10 to 10 of the box's frame; its walls are at -2 and 2.
  REQUIRE(inside);
  CHECK(inside->begin == Approx(0.4));
  CHECK(inside->end == Approx(0.6));
}

TEST_CASE("a segment through the roof is inside from the roof on") {
  // Down from 9 m to 3 m, the roof is at 6 m.
  const auto inside = house().crossing({0.0, 0.0, 9.0}, {0.0, 0.0, 3.0});

  REQUIRE(inside);
  CHECK(inside->begin == Approx(0.5));
  CHECK(inside->end == 1.0);
}

TEST_CASE("what touches a wall, an edge or the roof is not inside") {
  const UprightBox box = house();

  CHECK_FALSE(box.crossing({-5.0, 1.0, 3.0}, {5.0, 1.0, 3.0}));   // along a wall
  CHECK_FALSE(box.crossing({-5.0, 0.0, 6.0}, {5.0, 0.0, 6.0}));   // on the roof
  CHECK_FALSE(box.crossing({-3.0, 0.0, 3.0}, {-2.0, 0.0, 3.0}));  // up to a wall
  CHECK_FALSE(box.crossing({1.0, 2.0, 3.0}, {3.0, 0.0, 3.0}));    // over a corner
  CHECK_FALSE(box.contains({-2.0, 0.0, 3.0}));
  CHECK_FALSE(box.contains({0.0, 0.0, 6.0}));
  CHECK(box.contains({0.0, 0.0, 5.9}));
}

TEST_CASE("a box goes on below the ground") {
  CHECK(house().contains({0.0, 0.0, -100.0}));
  CHECK(house().crossing({-5.0, 0.0, -1.0}, {5.0, 0.0, -1.0}).has_value());
}

TEST_CASE("a box is turned counter-clockwise from east about its centre") {
  const UprightBox box{
      {.centre_m = {10.0, 20.0}, .size_m = {8.0, 2.0, 5.0}, .heading_rad = std::numbers::pi / 2.0}};

  // Its long side points north now.
  CHECK(box.contains(box.in_box({10.0, 23.9, 1.0})));
  CHECK_FALSE(box.contains(box.in_box({13.0, 20.0, 1.0})));
  CHECK(box.in_box({10.0, 23.0, 1.0}).isApprox(Eigen::Vector3d{3.0, 0.0, 1.0}));
}

TEST_CASE("the distance to a box is that to its nearest wall, edge or corner") {
  const UprightBox box = house();

  CHECK(box.distance_m({5.0, 0.0, 3.0}) == 3.0);
  CHECK(box.distance_m({5.0, 5.0, 3.0}) == 5.0);  // 3 and 4 m from an upright edge
  CHECK(box.distance_m({4.0, 2.0, 8.0}) == 3.0);  // 2, 1 and 2 m from a corner of the roof
  CHECK(box.distance_m({0.0, 0.0, 3.0}) == 0.0);
}

TEST_CASE("a line is over the rectangle at whatever height, and beyond its two points too") {
  const auto over = house().over_rectangle({-4.0, 0.0, 100.0}, {-3.0, 0.0, 90.0});

  REQUIRE(over);
  CHECK(over->begin == Approx(2.0));
  CHECK(over->end == Approx(6.0));
  CHECK_FALSE(house().over_rectangle({-4.0, 3.0, 0.0}, {4.0, 3.0, 0.0}));
}

}  // namespace
}  // namespace cuscus
