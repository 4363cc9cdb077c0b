#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

CityGeometry one_house() {
  return CityGeometry{city_of({house(rectangle(8.0, -1.0, 12.0, 1.0), 6.0)})};
}

TEST_CASE("a ball stops its radius before a wall, above a roof and around an edge") {
  const CityGeometry geometry = one_house();

  const auto wall = geometry.sweep({0.0, 0.0, 3.0}, {20.0, 0.0, 3.0}, 0.5);
  const auto roof = geometry.sweep({10.0, 0.0, 16.0}, {10.0, 0.0, 0.0}, 0.5);
  // 0.3 m beside the north-west edge: touched when 0.4 m before it.
  const auto edge = geometry.sweep({0.0, 1.3, 3.0}, {10.0, 1.3, 3.0}, 0.5);
  // 0.3 m above the roof: at its western rim.
  const auto rim = geometry.sweep({0.0, 0.0, 6.3}, {10.0, 0.0, 6.3}, 0.5);

  REQUIRE(wall);
  CHECK(wall->t == Approx(7.5 / 20.0));
  CHECK(wall->normal.isApprox(-Eigen::Vector3d::UnitX()));
  CHECK(wall->body == Body::kBuilding);
  REQUIRE(roof);
  CHECK(roof->t == Approx(9.5 / 16.0));
  CHECK(roof->normal.isApprox(Eigen::Vector3d::UnitZ()));
  REQUIRE(edge);
  CHECK(edge->t == Approx(0.76));
  CHECK(edge->normal.isApprox(Eigen::Vector3d{-0.8, 0.6, 0.0}));
  REQUIRE(rim);
  CHECK(rim->t == Approx(0.76));
  CHECK(rim->normal.isApprox(Eigen::Vector3d{-0.8, 0.0, 0.6}));
  CHECK_FALSE(geometry.sweep({0.0, 1.6, 3.0}, {20.0, 1.6, 3.0}, 0.5));
}

TEST_CASE("the ground, crowns and woods are touched too, whatever comes first") {
  City city;
  city.trees.push_back({.foot_m = {0.0, 30.0, 0.0}, .height_m = 9.0, .crown_radius_m = 2.0});
  city.woods.push_back(
      {.footprint = {.outer = rectangle(-50.0, -50.0, -30.0, -30.0), .courtyards = {}},
       .bottom_m = 0.0,
       .top_m = 12.0});
  const CityGeometry geometry{city};

  const auto ground = geometry.sweep({0.0, 0.0, 10.5}, {10.0, 0.0, -9.5}, 0.5);
  const auto tree = geometry.sweep({0.0, 0.0, 6.0}, {0.0, 55.0, 6.0}, 0.5);
  const auto wood = geometry.sweep({-40.0, 0.0, 6.0}, {-40.0, -59.0, 6.0}, 0.5);

  REQUIRE(ground);
  CHECK(ground->body == Body::kGround);
  CHECK(ground->t == Approx(0.5));
  REQUIRE(tree);
  CHECK(tree->body == Body::kTree);
  CHECK(tree->t == Approx(0.5));
  REQUIRE(wood);
  CHECK(wood->body == Body::kWood);
  CHECK(wood->t == Approx(0.5));
}

TEST_CASE("a ball that touches something has contact when it moves deeper, and else can leave") {
  const CityGeometry geometry = one_house();
  const Eigen::Vector3d touching{7.6, 0.0, 3.0};
  const Eigen::Vector3d in_the_wall{8.2, 0.0, 3.0};

  const auto deeper = geometry.sweep(touching, {8.0, 0.0, 3.0}, 0.5);
  REQUIRE(deeper);
  CHECK(deeper->t == 0.0);
  CHECK(deeper->normal.isApprox(-Eigen::Vector3d::UnitX()));
  CHECK_FALSE(geometry.sweep(touching, {7.0, 0.0, 3.0}, 0.5));
  CHECK_FALSE(geometry.sweep(touching, {7.6, 0.8, 3.0}, 0.5));
  CHECK(geometry.sweep(in_the_wall, {9.0, 0.0, 3.0}, 0.5)->t == 0.0);
  CHECK_FALSE(geometry.sweep(in_the_wall, {7.0, 0.0, 3.0}, 0.5));
  // Off the ground, and along it.
  CHECK_FALSE(geometry.sweep({0.0, 0.0, 0.4}, {0.0, 0.0, 2.0}, 0.5));
  CHECK_FALSE(geometry.sweep({0.0, 0.0, 0.4}, {2.0, 0.0, 0.4}, 0.5));
  CHECK(geometry.sweep({0.0, 0.0, 0.4}, {0.0, 0.0, 0.0}, 0.5)->t == 0.0);
}

TEST_CASE("a ball in a corner of two walls has contact with the one that it moves into") {
  const CityGeometry geometry{city_of(
      {house(rectangle(0.0, 0.0, 10.0, 1.0), 6.0), house(rectangle(0.0, 1.0, 1.0, 10.0), 6.0)})};
  const Eigen::Vector3d corner{1.4, 1.4, 3.0};

  CHECK(geometry.sweep(corner, {1.4, 0.0, 3.0}, 0.5)->normal.isApprox(Eigen::Vector3d::UnitY()));
  CHECK(geometry.sweep(corner, {0.0, 1.4, 3.0}, 0.5)->normal.isApprox(Eigen::Vector3d::UnitX()));
  CHECK_FALSE(geometry.sweep(corner, {3.0, 3.0, 3.0}, 0.5));
}

TEST_CASE("a ball of no radius and a ball that does not move are answered too") {
  const CityGeometry geometry = one_house();

  CHECK(geometry.sweep({0.0, 0.0, 3.0}, {20.0, 0.0, 3.0}, 0.0)->t == Approx(0.4));
  CHECK_FALSE(geometry.sweep({7.6, 0.0, 3.0}, {7.6, 0.0, 3.0}, 0.5));
}

TEST_CASE("at 50 m/s and one step a second no ball goes through a wall of 5 cm, nor stops early") {
  // 40 thin walls of all headings, some high up, and no ground near.
  Draws draws{random::CounterStream{51, 52}};
  City city;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector2d centre{draws.uniform(0.0, 100.0), draws.uniform(0.0, 100.0)};
    const double bottom_m = i % 3 == 0 ? 20.0 : 0.0;
    city.buildings.push_back(
        house(turned_rectangle(centre, {draws.uniform(5.0, 25.0), 0.05}, draws.uniform(0.0, 3.1)),
              bottom_m + draws.uniform(10.0, 30.0), bottom_m));
  }
  const CityGeometry geometry{city};
  constexpr int kSamples = 500;  // 10 cm; a ball of 0.2 m cannot be past a wall unseen
  constexpr double kRounding_m = 1e-9;

  int contacts = 0;
  int free = 0;
  for (int i = 0; i < 2000 / kOneIn; ++i) {
    const double radius_m = draws.uniform(0.2, 0.6);
    const Eigen::Vector3d p = draws.place({0.0, 0.0, 5.0}, {100.0, 100.0, 50.0});
    const Eigen::Vector3d q =
        p + 50.0 * draws.place({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}).normalized();
    const auto start = geometry.nearest(p, 2.0);
    if (start && start->distance_m <= radius_m) {
      continue;
    }
    const auto contact = geometry.sweep(p, q, radius_m);
    const double until = contact ? contact->t : 1.0;
    for (int k = 0; k <= kSamples; ++k) {
      const auto surface = geometry.nearest(p + until * k / kSamples * (q - p), 2.0);
      REQUIRE((!surface || surface->distance_m >= radius_m - kRounding_m));
    }
    if (!contact) {
      ++free;
      continue;
    }
    ++contacts;
    const auto surface = geometry.nearest(p + until * (q - p), 2.0);
    REQUIRE(surface);
    CHECK(surface->distance_m == Approx(radius_m).margin(kRounding_m));
    CHECK(contact->normal.dot(q - p) < 0.0);
    CHECK(contact->normal.isApprox(surface->normal, 1e-6));
  }
  CHECK(contacts > 500 / kOneIn);
  CHECK(free > 200 / kOneIn);
}

TEST_CASE("among houses with courtyards and storeys too a ball stops at the first surface") {
  const bool cells = GENERATE(true, false);
  const City city = cells ? city_of_cells(6) : town_of_stars(6);
  const double scale_m = cells ? 12.0 : 300.0;
  const CityGeometry geometry{city};
  Draws draws{random::CounterStream{53, 54}};

  int contacts = 0;
  for (int i = 0; i < 1000 / kOneIn; ++i) {
    const double radius_m = draws.uniform(0.1, 0.4);
    const Eigen::Vector3d low{0.0, 0.0, 0.5};
    const Eigen::Vector3d high{scale_m, scale_m, cells ? 8.0 : 40.0};
    const Eigen::Vector3d p = draws.place(low, high);
    const Eigen::Vector3d q = draws.place(low, high);
    const auto start = geometry.nearest(p, 2.0);
    if (start && start->distance_m <= radius_m) {
      continue;
    }
    const auto contact = geometry.sweep(p, q, radius_m);
    const double until = contact ? contact->t : 1.0;
    for (int k = 0; k <= 200; ++k) {
      const auto surface = geometry.nearest(p + until * k / 200 * (q - p), 2.0);
      REQUIRE((!surface || surface->distance_m >= radius_m - 1e-9));
    }
    if (contact) {
      const auto surface = geometry.nearest(p + until * (q - p), 2.0);
      REQUIRE(surface);
      CHECK(surface->distance_m == Approx(radius_m).margin(1e-9));
      ++contacts;
    }
  }
  CHECK(contacts > 200 / kOneIn);
}

}  // namespace
}  // namespace cuscus::city
