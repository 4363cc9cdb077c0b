#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

/// Rises by 10 m per 100 m to the east, from the origin on, over 200 m by 100 m.
City slope() {
  City city;
  city.terrain = Terrain{.cell_m = 100.0,
                         .columns = 3,
                         .rows = 2,
                         .height_m = {0.0F, 10.0F, 20.0F, 0.0F, 10.0F, 20.0F}};
  return city;
}

/// Hills of some metres on a grid of 10 m.
City hills() {
  Draws draws{random::CounterStream{61, 62}};
  City city;
  city.terrain = Terrain{
      .south_west_m = {-50.0, -30.0}, .cell_m = 10.0, .columns = 21, .rows = 16, .height_m = {}};
  for (std::size_t i = 0; i < city.terrain->columns * city.terrain->rows; ++i) {
    city.terrain->height_m.push_back(static_cast<float>(draws.uniform(0.0, 8.0)));
  }
  return city;
}

TEST_CASE("without terrain the ground is the plane at 0") {
  CHECK(CityGeometry{City{}}.ground_m({1e5, -3.0}) == 0.0);
}

TEST_CASE("terrain is bilinear between its heights, and beyond its rim as high as that") {
  City city;
  city.terrain = Terrain{.south_west_m = {100.0, 200.0},
                         .cell_m = 10.0,
                         .columns = 2,
                         .rows = 2,
                         .height_m = {1.0F, 3.0F, 5.0F, 11.0F}};
  const CityGeometry geometry{city};

  CHECK(geometry.ground_m({100.0, 200.0}) == 1.0);
  CHECK(geometry.ground_m({110.0, 200.0}) == 3.0);
  CHECK(geometry.ground_m({100.0, 210.0}) == 5.0);
  // 0.5 and 0.25: (1 + 3) / 2 = 2 in the south, (5 + 11) / 2 = 8 in the north.
  CHECK(geometry.ground_m({105.0, 202.5}) == Approx(3.5));
  CHECK(geometry.ground_m({0.0, 0.0}) == 1.0);
  CHECK(geometry.ground_m({105.0, 999.0}) == Approx(8.0));
}

TEST_CASE("a slope is hit where the ray meets it, with its normal") {
  const CityGeometry geometry{slope()};

  const auto level = geometry.first_hit({0.0, 50.0, 5.0}, {1.0, 0.0, 0.0}, 1000.0);
  const auto down = geometry.first_hit({150.0, 50.0, 20.0}, {0.0, 0.0, -1.0}, 1000.0);

  REQUIRE(level);
  CHECK(level->distance_m == Approx(50.0));
  CHECK(level->body == Body::kGround);
  CHECK(level->normal.isApprox(Eigen::Vector3d{-0.1, 0.0, 1.0}.normalized()));
  REQUIRE(down);
  CHECK(down->distance_m == Approx(5.0));
  CHECK_FALSE(geometry.first_hit({0.0, 50.0, 21.0}, {1.0, 0.0, 0.0}, 1000.0));
}

TEST_CASE("distances to a slope are along its normal, and a ball stops at it") {
  const CityGeometry geometry{slope()};
  const Eigen::Vector3d normal = Eigen::Vector3d{-0.1, 0.0, 1.0}.normalized();
  const Eigen::Vector3d p = Eigen::Vector3d{50.0, 50.0, 5.0} + 3.0 * normal;

  const auto surface = geometry.nearest(p, 5.0);
  const auto contact = geometry.sweep(p, p - 6.0 * normal, 1.5);

  REQUIRE(surface);
  CHECK(surface->distance_m == Approx(3.0));
  CHECK(surface->p_WS.isApprox(Eigen::Vector3d{50.0, 50.0, 5.0}));
  REQUIRE(contact);
  CHECK(contact->t == Approx(0.25));
  CHECK(contact->normal.isApprox(normal));
}

TEST_CASE("a house on a slope stands on it with all its corners, a bridge does not") {
  City city = slope();
  city.buildings = {house(rectangle(40.0, 40.0, 60.0, 60.0), 20.0, 5.0),
                    house(rectangle(140.0, 40.0, 160.0, 60.0), 40.0, 30.0)};
  const CityGeometry geometry{city};

  // The first has its bottom at the ground in its middle: 1 m above it in the west.
  CHECK(geometry.blocked({30.0, 50.0, 4.5}, {70.0, 50.0, 4.5}));
  CHECK_FALSE(geometry.blocked({130.0, 50.0, 25.0}, {170.0, 50.0, 25.0}));
}

TEST_CASE("the first hit of hills is where a walk along the ray first comes below the ground") {
  const CityGeometry geometry{hills()};
  Draws draws{random::CounterStream{63, 64}};
  constexpr int kSteps = 4000;

  int hits = 0;
  for (int i = 0; i < 400 / kOneIn; ++i) {
    const Eigen::Vector3d a = draws.place({-80.0, -60.0, 0.0}, {180.0, 150.0, 15.0});
    const Eigen::Vector3d b = draws.place({-80.0, -60.0, -2.0}, {180.0, 150.0, 15.0});
    const double length_m = (b - a).norm();
    const auto below = [&](double t) {
      const Eigen::Vector3d p = a + t * (b - a);
      return p.z() - geometry.ground_m(p.head<2>()) < 0.0;
    };
    int step = 0;
    while (step <= kSteps && !below(static_cast<double>(step) / kSteps)) {
      ++step;
    }
    const auto hit = geometry.first_hit(a, b - a, length_m);

    if (step > kSteps) {
      // It may have dipped in between two steps, by a hair.
      if (hit) {
        CHECK(below(hit->distance_m / length_m + 1e-6));
      }
      continue;
    }
    REQUIRE(hit);
    const double t = hit->distance_m / length_m;
    CHECK(t <= (step + 1e-6) / kSteps);
    // Earlier than the walk by less than a step, or by a dip between two steps.
    CHECK((t >= (step - 1.0) / kSteps || below(t + 1e-6)));
    ++hits;
  }
  CHECK(hits > 100 / kOneIn);
}

TEST_CASE("a ball comes to rest on hills at its radius, and never goes below them") {
  const CityGeometry geometry{hills()};
  Draws draws{random::CounterStream{65, 66}};
  constexpr double kRadius_m = 0.3;

  int contacts = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d p = draws.place({-80.0, -60.0, 9.0}, {180.0, 150.0, 15.0});
    const Eigen::Vector3d q = p + draws.place({-30.0, -30.0, -16.0}, {30.0, 30.0, 2.0});
    const auto contact = geometry.sweep(p, q, kRadius_m);
    const double until = contact ? contact->t : 1.0;
    for (int k = 0; k <= 200; ++k) {
      const Eigen::Vector3d at = p + until * k / 200 * (q - p);
      REQUIRE(at.z() >= geometry.ground_m(at.head<2>()));
    }
    if (contact) {
      const auto surface = geometry.nearest(p + until * (q - p), 1.0);
      REQUIRE(surface);
      // Where two cells meet the normal jumps.
      CHECK(surface->distance_m <= kRadius_m + 1e-6);
      ++contacts;
    }
  }
  CHECK(contacts > 100);
}

}  // namespace
}  // namespace cuscus::city
