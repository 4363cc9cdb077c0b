#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "netsim/channel/box_obstacles.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

/// A box of the radio's, and the same as a building.
struct Twin {
  netsim::BoxObstacle box;
  City city;
};

Twin random_twin(Draws& draws) {
  Twin twin;
  twin.box.shape = {
      .centre_m = {draws.uniform(-10.0, 10.0), draws.uniform(-10.0, 10.0)},
      .size_m = {draws.uniform(15.0, 30.0), draws.uniform(4.0, 14.0), draws.uniform(5.0, 25.0)},
      .heading_rad = draws.uniform(-3.0, 3.0)};
  twin.box.inner_spacing_m = 4.0;
  twin.box.inner_wall = {1.0};
  const auto& shape = twin.box.shape;
  twin.city =
      city_of({house(turned_rectangle(shape.centre_m, shape.size_m.head<2>(), shape.heading_rad),
                     shape.size_m.z())});
  twin.city.buildings[0].room_m = 4.0;
  return twin;
}

void check_equal(const Turn& turn, const netsim::Turn& expected) {
  CHECK(turn.at_a == Approx(expected.at_a).epsilon(1e-9).margin(1e-9));
  CHECK(turn.at_b == Approx(expected.at_b).epsilon(1e-9).margin(1e-9));
}

TEST_CASE("one box has the walls, turns and clearance that the radio's boxes have") {
  Draws draws{random::CounterStream{11, 12}};
  Twin twin = random_twin(draws);
  netsim::BoxObstacles boxes{{twin.box}};
  CityGeometry geometry{twin.city};
  int crossed = 0;
  int inside = 0;
  int cleared = 0;
  for (int i = 0; i < 4000 / kOneIn; ++i) {
    if (i % 20 == 0) {
      twin = random_twin(draws);
      boxes = netsim::BoxObstacles{{twin.box}};
      geometry = CityGeometry{twin.city};
    }
    const Eigen::Vector3d a = draws.place({-40.0, -40.0, 0.0}, {40.0, 40.0, 30.0});
    const Eigen::Vector3d b = draws.place({-40.0, -40.0, 0.0}, {40.0, 40.0, 30.0});
    std::vector<netsim::Obstruction> expected;
    boxes.find(a, b, 1e6, expected);
    Crossings found;
    geometry.crossings(a, b, found);

    INFO(a.transpose() << " to " << b.transpose());
    REQUIRE(expected.size() == 1);
    REQUIRE(expected[0].crossed == !found.buildings.empty());
    if (!expected[0].crossed) {
      // Golden sections find the least to about 1e-8 of the length.
      CHECK(geometry.clearance_m(0, a, b) ==
            Approx(expected[0].clearance_m).epsilon(1e-6).margin(1e-9));
      ++cleared;
      continue;
    }
    const Crossing& crossing = found.buildings[0];
    CHECK(crossing.outer_walls == expected[0].walls.outer);
    CHECK(crossing.inner_walls == expected[0].walls.inner);
    CHECK(crossing.mean_inner_walls == Approx(expected[0].inner_loss.value).margin(1e-9));
    CHECK(geometry.clearance_m(0, a, b) == 0.0);
    if (crossing.from_inside || crossing.to_inside) {
      ++inside;
      continue;
    }
    const Turns turns = geometry.turns(0, a, b);
    check_equal(turns.over, expected[0].turns[0]);
    check_equal(turns.left, expected[0].turns[1]);
    check_equal(turns.right, expected[0].turns[2]);
    ++crossed;
  }
  CHECK(crossed > 400 / kOneIn);
  CHECK(inside > 100 / kOneIn);
  CHECK(cleared > 500 / kOneIn);
}

TEST_CASE("the way over goes over all parts of a building between the ends, and no others") {
  // A low wing, a tower of 30 m, and another behind B.
  const CityGeometry geometry{
      city_of({building({house(rectangle(10.0, -20.0, 20.0, 20.0), 10.0).prisms[0],
                         house(rectangle(20.0, -20.0, 30.0, 20.0), 30.0).prisms[0],
                         house(rectangle(60.0, -20.0, 70.0, 20.0), 90.0).prisms[0]})})};

  const Turns turns = geometry.turns(0, {0.0, 0.0, 5.0}, {50.0, 0.0, 5.0});

  // From A to the tower's near edge at (20, 30), from B to its far edge at (30, 30).
  CHECK(turns.over.at_a == Approx(std::tan(0.5 * std::atan2(25.0, 20.0))));
  CHECK(turns.over.at_b == Approx(std::tan(0.5 * std::atan2(25.0, 20.0))));
}

TEST_CASE("around the sides only parts at the line's height are in the way") {
  // A tower 4 m wide on a podium 40 m wide: 15 m up it is the tower alone.
  const CityGeometry geometry{
      city_of({building({house(rectangle(10.0, -20.0, 20.0, 20.0), 10.0).prisms[0],
                         house(rectangle(13.0, -2.0, 17.0, 2.0), 30.0, 10.0).prisms[0]})})};

  const Turns high = geometry.turns(0, {0.0, 0.0, 15.0}, {30.0, 0.0, 15.0});
  const Turns low = geometry.turns(0, {0.0, 0.0, 5.0}, {30.0, 0.0, 5.0});

  CHECK(high.left.at_a == Approx(std::tan(0.5 * std::atan2(2.0, 13.0))));
  CHECK(high.right.at_b == Approx(std::tan(0.5 * std::atan2(2.0, 13.0))));
  CHECK(low.left.at_a == Approx(std::tan(0.5 * std::atan2(20.0, 10.0))));
}

TEST_CASE("from a courtyard there is a way over, and none around") {
  Building block = house(rectangle(0.0, 0.0, 30.0, 30.0), 20.0);
  block.prisms[0].footprint.courtyards.push_back(clockwise(rectangle(10.0, 10.0, 20.0, 20.0)));
  const CityGeometry geometry{city_of({block})};

  const Turns turns = geometry.turns(0, {15.0, 15.0, 5.0}, {60.0, 15.0, 5.0});

  CHECK(turns.left.at_a == kInfinite);
  CHECK(turns.right.at_b == kInfinite);
  // The near edge of the eastern wing, at 20; its western wing is in A's back.
  CHECK(turns.over.at_a == Approx(std::tan(0.5 * std::atan2(15.0, 5.0))));
  CHECK(turns.over.at_b == Approx(std::tan(0.5 * std::atan2(15.0, 30.0))));
}

TEST_CASE("the clearance is the least along the segment, for shapes that are not convex too") {
  const City city = town_of_stars(21);
  const CityGeometry geometry{city};
  Draws draws{random::CounterStream{22, 23}};
  constexpr int kSamples = 4000;

  int checked = 0;
  for (int i = 0; i < std::max(10, 60 / kOneIn); ++i) {
    const Eigen::Vector3d a = draws.place({0.0, 0.0, 0.0}, {300.0, 300.0, 45.0});
    const Eigen::Vector3d b = a + draws.place({-60.0, -60.0, -a.z()}, {60.0, 60.0, 20.0});
    std::vector<std::uint32_t> buildings;
    geometry.near(a, b, 10.0, buildings);
    for (const std::uint32_t building : buildings) {
      const double clearance_m = geometry.clearance_m(building, a, b);
      const CityGeometry alone{city_of({city.buildings[building]})};
      double sampled_m = kInfinite;
      std::vector<Surface> surfaces;
      for (int k = 1; k < kSamples; ++k) {
        const double t = static_cast<double>(k) / kSamples;
        alone.surfaces(a + t * (b - a), 200.0, surfaces);
        const double distance_m = std::max(0.0, surfaces.front().distance_m);
        sampled_m =
            std::min(sampled_m, distance_m * distance_m / (t * (1.0 - t)) / (2.0 * (b - a).norm()));
      }
      CHECK(clearance_m <= sampled_m + 1e-12);
      // Between samples 3 cm apart at most it is lower by little: D changes by less than 3 cm.
      CHECK(clearance_m >= sampled_m - 0.1 - 0.1 * sampled_m);
      ++checked;
    }
  }
  CHECK(checked > 50 / kOneIn);
}

}  // namespace
}  // namespace cuscus::city
