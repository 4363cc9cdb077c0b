#include "world/collision/passage.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/world/blocks.h"

namespace cuscus::world {
namespace {

constexpr CollisionBody kStops{.radius_m = 0.3, .behaviour = CollisionBehaviour::kStop};
constexpr CollisionBody kBounces{
    .radius_m = 0.3, .behaviour = CollisionBehaviour::kBounce, .restitution = 0.4};
constexpr double kStep_s = 1e-3;

/// A wall of 1 cm across the x axis at x = 10 m, as high as a house.
const city::CityGeometry& wall() {
  static const city::CityGeometry geometry{
      city_of({{.low_m = {10.0, -20.0, 0.0}, .high_m = {10.01, 20.0, 15.0}}})};
  return geometry;
}

Passage fly(const Surroundings& surroundings, const CollisionBody& body, const Eigen::Vector3d& p,
            const Eigen::Vector3d& v) {
  return passage(surroundings, body, p, p + kStep_s * v, v);
}

TEST_CASE("no speed takes a ball through a thin wall") {
  const Surroundings city{&wall()};
  for (const double speed_mps : {1.0, 50.0, 500.0, 5e4, 5e6}) {
    CAPTURE(speed_mps);
    Eigen::Vector3d p{0.0, 1.0, 5.0};
    Eigen::Vector3d v{speed_mps, 0.0, 0.0};
    int impacts = 0;

    for (int step = 0; step < 12'000 && impacts == 0; ++step) {
      const Passage passed = fly(city, kStops, p, v);
      p = passed.p_WC;
      v = passed.v_WC_mps;
      impacts += static_cast<int>(passed.impact_count);
    }

    CHECK(impacts == 1);
    CHECK(p.x() == Approx(10.0 - kStops.radius_m).margin(1e-8));
    CHECK(v.x() == 0.0);
  }
}

TEST_CASE("a ball slides along a wall and keeps its speed along it") {
  const Surroundings city{&wall()};
  Eigen::Vector3d p{9.69, 0.0, 5.0};
  Eigen::Vector3d v{20.0, 3.0, 1.0};

  for (int step = 0; step < 1000; ++step) {
    const Passage passed = fly(city, kStops, p, v);
    p = passed.p_WC;
    v = passed.v_WC_mps + Eigen::Vector3d{0.02, 0.0, 0.0};  // pressed on at 20 m/s²
  }

  CHECK(p.x() == Approx(9.7).margin(1e-5));
  CHECK(p.y() == Approx(3.0).margin(1e-6));
  CHECK(p.z() == Approx(6.0).margin(1e-6));
  CHECK(v.y() == 3.0);
}

TEST_CASE("a vehicle of FL-AIR loses all its speed") {
  CollisionBody faithful = kStops;
  faithful.loses_all_speed = true;

  const Passage passed = fly(Surroundings{&wall()}, faithful, {9.695, 0.0, 5.0}, {20.0, 3.0, 1.0});

  CHECK(passed.impact_count == 1);
  CHECK(passed.v_WC_mps.isZero(0.0));
}

TEST_CASE("a ball that bounces comes back with its part of the speed") {
  const Surroundings city{&wall()};
  // 5 mm before the wall at 10 m/s: half a step there, half a step back at 4 m/s.
  const Passage passed = fly(city, kBounces, {9.695, 0.0, 5.0}, {10.0, 2.0, 0.0});

  CHECK(passed.v_WC_mps.isApprox(Eigen::Vector3d{-4.0, 2.0, 0.0}));
  CHECK(passed.p_WC.x() == Approx(9.7 - 0.5 * kStep_s * 4.0));
  CHECK(passed.p_WC.y() == Approx(2.0 * kStep_s));
  CHECK(passed.impacts[0].speed_mps == Approx(10.0));
  CHECK(fly(city, kBounces, {9.7, 0.0, 5.0}, {0.09, 0.0, 0.0}).v_WC_mps.isZero());
}

TEST_CASE("a ball in a corner, sharp ones too, gets into neither wall") {
  const double depth_m = GENERATE(0.5, 5.0, 40.0);
  // Two faces that meet at the origin: the y axis, and a slope that is the sharper the deeper.
  city::City city = city_of({{.low_m = {-1.0, -50.0, 0.0}, .high_m = {0.0, 50.0, 20.0}}});
  city::Building slope;
  slope.prisms.push_back(
      {.footprint = {.outer = {{0.0, 0.0}, {10.0, -1.0}, {10.0, depth_m}}, .courtyards = {}},
       .bottom_m = 0.0,
       .top_m = 20.0});
  city.buildings.push_back(slope);
  const city::CityGeometry geometry{city};
  const Surroundings surroundings{&geometry};
  Eigen::Vector3d p{1.0, 30.0, 5.0};
  Eigen::Vector3d v{-5.0, -20.0, 0.0};
  double nearest_m = 1.0;

  for (int step = 0; step < 5000; ++step) {
    const Passage passed = fly(surroundings, kStops, p, v);
    p = passed.p_WC;
    v = passed.v_WC_mps + Eigen::Vector3d{-0.01, -0.02, 0.0};
    nearest_m = std::min(nearest_m, surroundings.nearest(p, 1.0)->distance_m);
  }

  CHECK(nearest_m == Approx(kStops.radius_m).margin(1e-7));
  CHECK(p.x() >= 0.3 - 1e-7);
}

TEST_CASE("what comes down on ground or roof stands exactly on it") {
  const city::CityGeometry house{
      city_of({{.low_m = {-5.0, -5.0, 0.0}, .high_m = {5.0, 5.0, 12.5}}})};

  const Passage landed = fly(Surroundings{}, kStops, {3.0, 4.0, 0.3001}, {5.0, 0.0, -2.0});
  const Passage on_roof = fly(Surroundings{&house}, kStops, {1.0, 2.0, 12.8004}, {0.0, 0.0, -1.0});

  CHECK(landed.rests);
  CHECK(landed.p_WC.z() - kStops.radius_m == 0.0);
  CHECK(landed.v_WC_mps.isZero(0.0));
  CHECK(on_roof.rests);
  CHECK(on_roof.p_WC.z() == Approx(12.8).margin(1e-12));
  CHECK(on_roof.impacts[0].contact.body == city::Body::kBuilding);
}

TEST_CASE("a ball that bounces comes to rest on the ground in the end") {
  Eigen::Vector3d p{0.0, 0.0, 1.3};
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  bool rests = false;
  double highest_after_first_m = 0.0;
  bool bounced = false;

  for (int step = 0; step < 5000 && !rests; ++step) {
    v.z() -= 9.81 * kStep_s;
    const Passage passed = fly(Surroundings{}, kBounces, p, v);
    p = passed.p_WC;
    v = passed.v_WC_mps;
    rests = passed.rests;
    bounced = bounced || passed.impact_count > 0;
    highest_after_first_m = bounced ? std::max(highest_after_first_m, p.z() - 0.3) : 0.0;
  }

  CHECK(rests);
  // A fall of 1 m, and back e² of it.
  CHECK(highest_after_first_m == Approx(0.16).epsilon(0.02));
}

}  // namespace
}  // namespace cuscus::world
