#include "uav-agent/missions/circle_mission.h"

#include <catch2/catch.hpp>
#include <numbers>

namespace cuscus::missions {
namespace {

const CircleParameters kOffsetCircle{.p_WC_centre_m = {5.0, -3.0, 10.0},
                                     .radius_m = 20.0,
                                     .speed_mps = 2.0,
                                     .acceleration_mps2 = 2.0};

constexpr SimTime at_ms(int milliseconds) {
  return SimTime{std::chrono::milliseconds{milliseconds}};
}

/// A mission of slot 1 of 4 that has arrived on its circle, and the instant at which it did.
struct OnCircle {
  CircleMission mission{kOffsetCircle, 1, 4};
  flight::VehicleEstimate estimate;
  int now_ms = 0;

  OnCircle() {
    estimate.p_WB_m = mission.entry_point_m();
    REQUIRE(mission.setpoint(at_ms(now_ms), estimate, {}, 0.0).is_finite());
    REQUIRE(mission.circling());
  }
  flight::Setpoint next(int milliseconds = 5) {
    now_ms += milliseconds;
    return mission.setpoint(at_ms(now_ms), estimate, {}, 0.25);
  }
};

TEST_CASE("a slot enters the circle at its own angle") {
  const CircleMission mission{kOffsetCircle, 1, 4};

  CHECK((mission.entry_point_m() - Eigen::Vector3d{5.0, 17.0, 10.0}).norm() < 1e-9);
}

TEST_CASE("the way to the circle is straight and ends at rest") {
  CircleMission mission{kOffsetCircle, 1, 4};
  flight::VehicleEstimate estimate;
  estimate.p_WB_m = {5.0, 7.0, 10.0};

  const auto first = mission.setpoint(at_ms(0), estimate, {}, 0.0);
  CHECK((first.p_WB_m - estimate.p_WB_m).norm() < 1e-9);
  for (int ms = 0; ms <= 20'000 && !mission.circling(); ms += 5) {
    const auto setpoint = mission.setpoint(at_ms(ms), estimate, {}, 0.0);
    CHECK(setpoint.p_WB_m.x() == Approx(5.0));
    CHECK(setpoint.p_WB_m.z() == Approx(10.0));
    CHECK(setpoint.v_WB_mps.norm() <= kOffsetCircle.entry_speed_mps + 1e-9);
    estimate.p_WB_m = setpoint.p_WB_m;
    estimate.v_WB_mps = setpoint.v_WB_mps;
  }

  CHECK(mission.circling());
  CHECK((estimate.p_WB_m - mission.entry_point_m()).norm() < 0.01);
  CHECK(estimate.v_WB_mps.norm() < 0.05);
}

TEST_CASE("a mission does not circle before the vehicle has arrived") {
  CircleMission mission{kOffsetCircle, 1, 4};
  flight::VehicleEstimate estimate;
  estimate.p_WB_m = {5.0, 7.0, 10.0};

  for (int ms = 0; ms <= 60'000; ms += 5) {
    CHECK(mission.setpoint(at_ms(ms), estimate, {}, 0.0).is_finite());
  }

  CHECK_FALSE(mission.circling());
}

TEST_CASE("on the circle the set-point is the nearest point, moving counter-clockwise") {
  OnCircle on;
  on.estimate.p_WB_m = {5.0, 18.5, 10.4};  // 1.5 m outside, 0.4 m above
  flight::Setpoint setpoint;
  for (int i = 0; i < 1000; ++i) {
    setpoint = on.next();
  }

  CHECK((setpoint.p_WB_m - Eigen::Vector3d{5.0, 17.0, 10.0}).norm() < 1e-9);
  CHECK((setpoint.v_WB_mps - Eigen::Vector3d{-2.0, 0.0, 0.0}).norm() < 1e-9);
  CHECK(setpoint.yaw_rad == 0.25);
}

TEST_CASE("a vehicle starts along the circle with its acceleration, not with a leap") {
  OnCircle on;

  CHECK(on.next(100).v_WB_mps.norm() == Approx(0.2));
  CHECK(on.next(100).v_WB_mps.norm() == Approx(0.4));
  // A pause of the process is not made up for in one leap.
  CHECK(on.next(5000).v_WB_mps.norm() == Approx(0.6));
}

TEST_CASE("the centripetal acceleration of the present speed is fed forward") {
  OnCircle on;
  on.estimate.v_WB_mps = {-3.0, 0.0, 0.0};

  const auto setpoint = on.next();

  CHECK((setpoint.a_WB_mps2 - Eigen::Vector3d{0.0, -9.0 / 20.0, 0.0}).norm() < 1e-9);
}

}  // namespace
}  // namespace cuscus::missions
