#include "uav-agent/flight/trapezoid_profile.h"

#include <catch2/catch.hpp>

namespace cuscus::flight {
namespace {

TEST_CASE("a long move has two ramps and a cruise between them") {
  const TrapezoidProfile profile{1.0, 11.0, 2.0, 1.0};

  // Ramps of 2 s and 2 m each, 6 m of cruise at 2 m/s.
  CHECK(profile.duration_s() == Approx(7.0));
  CHECK(profile.at(-1.0).position_m == 1.0);
  CHECK(profile.at(1.0).position_m == Approx(1.5));
  CHECK(profile.at(1.0).velocity_mps == Approx(1.0));
  CHECK(profile.at(1.0).acceleration_mps2 == 1.0);
  CHECK(profile.at(3.5).position_m == Approx(6.0));
  CHECK(profile.at(3.5).velocity_mps == Approx(2.0));
  CHECK(profile.at(3.5).acceleration_mps2 == 0.0);
  CHECK(profile.at(6.0).position_m == Approx(10.5));
  CHECK(profile.at(6.0).acceleration_mps2 == -1.0);
  CHECK(profile.at(7.0).position_m == 11.0);
  CHECK(profile.at(99.0).velocity_mps == 0.0);
}

TEST_CASE("a short move never reaches its speed") {
  const TrapezoidProfile profile{0.0, -1.0, 2.0, 1.0};

  // Half of the way in each ramp: t = 2 sqrt(way / a).
  CHECK(profile.duration_s() == Approx(2.0));
  CHECK(profile.at(1.0).position_m == Approx(-0.5));
  CHECK(profile.at(1.0 - 1e-9).velocity_mps == Approx(-1.0));
  CHECK(profile.at(2.0).position_m == -1.0);
}

TEST_CASE("a move to where one is takes no time") {
  const TrapezoidProfile profile{3.0, 3.0, 2.0, 1.0};

  CHECK(profile.duration_s() == 0.0);
  CHECK(profile.at(0.0).position_m == 3.0);
  CHECK(profile.at(1.0).position_m == 3.0);
}

}  // namespace
}  // namespace cuscus::flight
