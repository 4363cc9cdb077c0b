#include "world/collision/encounter.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/random/counter_stream.h"
#include "world/collision/close_pairs.h"

namespace cuscus::world {
namespace {

constexpr CollisionBody bouncing(double mass_kg, double restitution) {
  return {.radius_m = 0.5,
          .mass_kg = mass_kg,
          .behaviour = CollisionBehaviour::kBounce,
          .restitution = restitution};
}

/// A ball that goes at `v` for a second.
MovingBall moving(const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
  return {.p_WC = p, .target = p + v, .v_mps = v};
}

TEST_CASE("balls meet when their surfaces do, however fast they are") {
  const double speed_mps = GENERATE(1.0, 500.0, 1e6);
  // 10 m apart, reach 1 m, both moving: 9 m at twice the speed.
  const auto head_on = meeting(moving({0.0, 0.0, 0.0}, {speed_mps, 0.0, 0.0}),
                               moving({10.0, 0.0, 0.0}, {-speed_mps, 0.0, 0.0}), 1.0);

  if (speed_mps < 4.5) {
    CHECK_FALSE(head_on.has_value());
  } else {
    CHECK(*head_on == Approx(4.5 / speed_mps));
  }
}

TEST_CASE("balls that pass at more than their reach, part or keep their distance do not meet") {
  const MovingBall resting = moving({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});

  CHECK_FALSE(meeting(resting, moving({-5.0, 1.001, 0.0}, {10.0, 0.0, 0.0}), 1.0));
  CHECK(*meeting(resting, moving({-5.0, 0.999, 0.0}, {10.0, 0.0, 0.0}), 1.0) ==
        Approx((5.0 - std::sqrt(1.0 - 0.999 * 0.999)) / 10.0));
  CHECK_FALSE(meeting(resting, moving({0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}), 1.0));
  CHECK(*meeting(resting, moving({0.5, 0.0, 0.0}, {-1.0, 0.0, 0.0}), 1.0) == 0.0);
  CHECK_FALSE(meeting(resting, moving({0.5, 0.0, 0.0}, {0.0, 0.0, 0.0}), 1.0));
}

TEST_CASE("an impact keeps momentum and turns the relative speed by the smaller restitution") {
  MovingBall a = moving({0.0, 0.0, 0.0}, {6.0, 1.0, 0.0});
  MovingBall b = moving({4.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  const CollisionBody body_a = bouncing(1.0, 0.5);
  const CollisionBody body_b = bouncing(2.0, 0.9);
  const Eigen::Vector3d momentum = 1.0 * a.v_mps + 2.0 * b.v_mps;

  const double speed_mps = part(a, body_a, b, body_b, *meeting(a, b, 1.0));

  CHECK(speed_mps == Approx(6.0));
  CHECK((1.0 * a.v_mps + 2.0 * b.v_mps).isApprox(momentum));
  CHECK((b.v_mps - a.v_mps).isApprox(Eigen::Vector3d{3.0, 0.0, 0.0}));
  // They met after half a second with a at x = 3 m, and a then goes on at 0 m/s, b at 3 m/s.
  CHECK(a.target.isApprox(Eigen::Vector3d{3.0, 1.0, 0.0}));
  CHECK(b.target.isApprox(Eigen::Vector3d{5.5, 1.0, 0.0}));
}

TEST_CASE("one that stops and one that bounces go on together") {
  MovingBall a = moving({0.0, 0.0, 0.0}, {4.0, 0.0, 0.0});
  MovingBall b = moving({2.0, 0.0, 0.0}, {0.0, 0.0, 0.0});

  part(a, {.radius_m = 0.5}, b, bouncing(1.0, 0.9), *meeting(a, b, 1.0));

  CHECK(a.v_mps.isApprox(Eigen::Vector3d{2.0, 0.0, 0.0}));
  CHECK(b.v_mps.isApprox(a.v_mps));
  CHECK((b.target - a.target).norm() == Approx(1.0));
}

TEST_CASE("every pair that meets is among the close ones, at any density and speed") {
  const double speed_mps = GENERATE(5.0, 60.0, 3000.0);
  constexpr std::uint32_t kBalls = 60;
  constexpr double kCloseStep_s = 1e-2;
  const random::CounterStream stream{5, 1};
  std::uint64_t drawn = 0;
  const auto vector = [&](double half) -> Eigen::Vector3d {
    const double x = half * (2.0 * stream.uniform(drawn++) - 1.0);
    const double y = half * (2.0 * stream.uniform(drawn++) - 1.0);
    return {x, y, 0.2 * half * (2.0 * stream.uniform(drawn++) - 1.0)};
  };
  std::vector<Eigen::Vector3d> centres;
  std::vector<double> radii_m;
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    centres.push_back(vector(8.0));
    radii_m.push_back(i % 7 == 0 ? 0.0 : 0.2 + 0.1 * (i % 4));
  }
  ClosePairs close{radii_m};
  int met = 0;
  std::size_t listed = 0;

  for (int step = 0; step < 300; ++step) {
    std::vector<MovingBall> balls;
    double most_way_m = 0.0;
    for (const Eigen::Vector3d& centre : centres) {
      const Eigen::Vector3d way = kCloseStep_s * (vector(speed_mps) - 0.2 * centre);
      balls.push_back({.p_WC = centre, .target = centre + way, .v_mps = way / kCloseStep_s});
      most_way_m = std::max(most_way_m, way.norm());
    }
    const auto pairs = close.during(centres, most_way_m);
    listed += pairs.size();
    for (std::uint32_t a = 0; a < kBalls; ++a) {
      for (std::uint32_t b = a + 1; b < kBalls; ++b) {
        if (radii_m[a] > 0.0 && radii_m[b] > 0.0 &&
            meeting(balls[a], balls[b], radii_m[a] + radii_m[b])) {
          ++met;
          const BallPair pair{.a = a, .b = b};
          REQUIRE(std::find(pairs.begin(), pairs.end(), pair) != pairs.end());
        }
      }
    }
    for (std::uint32_t i = 0; i < kBalls; ++i) {
      centres[i] = balls[i].target;
    }
  }

  CHECK(met > 10);  // it is not empty words
  if (speed_mps < 10.0) {
    CHECK(listed < 300 * kBalls * kBalls / 10);  // a fifth of all pairs: it saves something
  }
}

}  // namespace
}  // namespace cuscus::world
