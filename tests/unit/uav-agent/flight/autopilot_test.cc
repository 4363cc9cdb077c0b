#include "uav-agent/flight/autopilot.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/flight_rig.h"

namespace cuscus::flight {
namespace {

using tests::FlightRig;

constexpr double kAltitude_m = 5.0;

Setpoint hold_at(double x_m, double altitude_m = kAltitude_m) {
  Setpoint setpoint;
  setpoint.p_WB_m = {x_m, 0.0, altitude_m};
  return setpoint;
}

void run(FlightRig& rig, double seconds, const FlightRig::Guidance& guidance) {
  const auto steps = static_cast<int>(std::lround(seconds * 1000.0));
  for (int i = 0; i < steps; ++i) {
    rig.step(guidance);
  }
}

const FlightRig::Guidance kHover = [](std::size_t, SimTime) { return hold_at(0.0); };

/// A rig whose vehicle hovers at kAltitude_m.
FlightRig hovering(FlightRig::Settings settings = {}) {
  FlightRig rig{settings};
  rig.pilot(0).take_off(kAltitude_m);
  run(rig, 12.0, kHover);
  return rig;
}

TEST_CASE("a vehicle stays on the ground until it is told to take off") {
  FlightRig rig{{}};

  run(rig, 2.0, kHover);

  CHECK(rig.pilot(0).state() == FlightState::kStopped);
  CHECK(rig.on_ground(0));
  CHECK_FALSE(rig.pilot(0).motors_on());
}

TEST_CASE("a vehicle without sensors does not take off") {
  Autopilot pilot{Airframe{}};
  pilot.take_off(kAltitude_m);

  pilot.sense(sim_time(1'000'000), std::nullopt, std::nullopt);

  CHECK(pilot.act(sim_time(1'000'000), std::nullopt) == MotorCommands{});
  CHECK(pilot.state() == FlightState::kStopped);
}

TEST_CASE("a vehicle takes off straight up and then flies") {
  FlightRig rig{{}};
  rig.pilot(0).take_off(kAltitude_m);
  run(rig, 0.1, kHover);
  CHECK(rig.pilot(0).state() == FlightState::kTakingOff);

  double off_axis_m = 0.0;
  double top_m = 0.0;
  for (int i = 0; i < 12'000; ++i) {
    rig.step(kHover);
    off_axis_m = std::max(off_axis_m, rig.truth(0).p_WB_m.head<2>().norm());
    top_m = std::max(top_m, rig.truth(0).p_WB_m.z());
  }

  CHECK(rig.pilot(0).state() == FlightState::kFlying);
  CHECK(rig.truth(0).p_WB_m.z() == Approx(kAltitude_m).margin(0.05));
  CHECK(off_axis_m < 0.1);
  CHECK(top_m < kAltitude_m + 0.3);
}

TEST_CASE("a vehicle lands where it is told to, and stops its motors") {
  FlightRig rig = hovering();

  rig.pilot(0).land();
  CHECK(rig.pilot(0).state() == FlightState::kLanding);
  double touchdown_mps = 0.0;
  for (int i = 0; i < 15'000 && !rig.on_ground(0); ++i) {
    touchdown_mps = -rig.truth(0).v_WB_W_mps.z();
    rig.step(kHover);
  }
  run(rig, 3.0, kHover);

  CHECK(rig.pilot(0).state() == FlightState::kStopped);
  CHECK(rig.on_ground(0));
  CHECK_FALSE(rig.pilot(0).motors_on());
  CHECK(touchdown_mps < 0.6);
  CHECK(rig.truth(0).p_WB_m.head<2>().norm() < 0.2);
}

void check_lands_in_failsafe(FlightRig& rig, FailsafeReason reason) {
  double steepest_rad = 0.0;
  double touchdown_mps = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    if (!rig.on_ground(0)) {
      touchdown_mps = -rig.truth(0).v_WB_W_mps.z();
      steepest_rad = std::max(steepest_rad, tilt(rig.truth(0).q_WB));
    }
    rig.step(kHover);
  }
  CHECK(rig.pilot(0).state() == FlightState::kFailsafe);
  CHECK(rig.pilot(0).failsafe_reason() == reason);
  CHECK(rig.on_ground(0));
  CHECK_FALSE(rig.pilot(0).motors_on());
  CHECK(touchdown_mps < 1.2);
  CHECK(steepest_rad < 0.3);
}

TEST_CASE("200 ms without motion capture bring a vehicle down, level, and stop its motors") {
  FlightRig rig = hovering();

  rig.silence_motion_capture(0, true);
  run(rig, 0.19, kHover);
  CHECK(rig.pilot(0).state() == FlightState::kFlying);
  run(rig, 0.03, kHover);
  CHECK(rig.pilot(0).state() == FlightState::kFailsafe);

  check_lands_in_failsafe(rig, FailsafeReason::kMotionCaptureLost);
}

TEST_CASE("without motion capture the motors stop soon after touch-down, not at the deadline") {
  FlightRig rig{{.seed = GENERATE(1U, 2U, 3U)}};
  rig.pilot(0).take_off(10.0);
  const auto hover = [](std::size_t, SimTime) { return hold_at(0.0, 10.0); };
  run(rig, 15.0, hover);
  REQUIRE(rig.pilot(0).state() == FlightState::kFlying);

  rig.silence_motion_capture(0, true);
  for (int i = 0; i < 30'000 && !rig.on_ground(0); ++i) {
    rig.step(hover);
  }
  REQUIRE(rig.on_ground(0));
  CHECK(rig.pilot(0).motors_on());
  run(rig, 3.0, hover);

  // 1 m of imagined sinking at 0.8 m/s, and as much again for what dead reckoning is off by; the
  // deadline is another 12 s away.
  CHECK_FALSE(rig.pilot(0).motors_on());
}

TEST_CASE("a shorter loss of motion capture changes nothing") {
  FlightRig rig = hovering();

  rig.silence_motion_capture(0, true);
  run(rig, 0.15, kHover);
  rig.silence_motion_capture(0, false);
  run(rig, 3.0, kHover);

  CHECK(rig.pilot(0).state() == FlightState::kFlying);
  CHECK((rig.truth(0).p_WB_m - hold_at(0.0).p_WB_m).norm() < 0.05);
}

TEST_CASE("a lost IMU brings a vehicle down") {
  FlightRig rig = hovering();

  rig.silence_imu(0, true);

  check_lands_in_failsafe(rig, FailsafeReason::kImuLost);
}

TEST_CASE("a set-point that is not finite brings a vehicle down") {
  FlightRig rig = hovering();

  run(rig, 0.01,
      [](std::size_t, SimTime) { return hold_at(std::numeric_limits<double>::quiet_NaN()); });

  check_lands_in_failsafe(rig, FailsafeReason::kNotFinite);
}

TEST_CASE("failsafe is for good, even when the cause is gone") {
  FlightRig rig = hovering();
  rig.silence_motion_capture(0, true);
  run(rig, 0.3, kHover);

  rig.silence_motion_capture(0, false);
  rig.pilot(0).take_off(kAltitude_m);
  rig.pilot(0).land();

  check_lands_in_failsafe(rig, FailsafeReason::kMotionCaptureLost);
}

TEST_CASE("a reading that is not finite is a reason for failsafe and never reaches the motors") {
  FlightRig rig = hovering();
  Autopilot& pilot = rig.pilot(0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto kind = GENERATE(0, 1, 2);

  const SimTime now = rig.now() + std::chrono::milliseconds{1};
  std::optional<ImuReading> imu;
  std::optional<MotionCaptureReading> capture;
  if (kind == 0) {
    imu = ImuReading{.time = now, .angular_rate_B_radps = {0.0, nan, 0.0}};
  } else if (kind == 1) {
    capture = MotionCaptureReading{.time = now, .p_WB_m = {nan, 0.0, 0.0}};
  } else {
    // Finite, but the estimate overflows.
    imu = ImuReading{.time = now, .specific_force_B_mps2 = {1e308, 1e308, 1e308}};
    pilot.sense(now, imu, std::nullopt);
    imu->time += std::chrono::milliseconds{50};
    imu->angular_rate_B_radps = {1e308, 1e308, 1e308};
  }
  pilot.sense(now, imu, capture);
  const MotorCommands commands = pilot.act(now, hold_at(0.0));

  CHECK(pilot.state() == FlightState::kFailsafe);
  for (const double command : commands) {
    CHECK(std::isfinite(command));
    CHECK(command >= 0.0);
    CHECK(command <= 1.0);
  }
}

TEST_CASE("a vehicle that is upset beyond the limit goes into failsafe") {
  FlightRig rig = hovering();
  Autopilot& pilot = rig.pilot(0);

  const SimTime now = rig.now() + std::chrono::milliseconds{1};
  for (int i = 0; i < 60 && pilot.state() == FlightState::kFlying; ++i) {
    const SimTime then = now + i * std::chrono::milliseconds{10};
    const Eigen::Quaterniond q{Eigen::AngleAxisd{0.03 * i, Eigen::Vector3d::UnitX()}};
    pilot.sense(then,
                ImuReading{.time = then,
                           .angular_rate_B_radps = {3.0, 0.0, 0.0},
                           .specific_force_B_mps2 = {0.0, 0.0, 9.81}},
                MotionCaptureReading{.time = then, .p_WB_m = {0.0, 0.0, 5.0}, .q_WB = q});
  }

  CHECK(pilot.state() == FlightState::kFailsafe);
  CHECK(pilot.failsafe_reason() == FailsafeReason::kTiltBeyondLimit);
}

TEST_CASE("a vehicle whose estimator knows of it hovers by the noisiest motion capture there is") {
  FlightRig rig{{.position_noise_m = 1.0}};  // the most that a scenario may ask for
  rig.pilot(0).take_off(kAltitude_m);
  run(rig, 20.0, kHover);

  double worst_m = 0.0;
  for (int i = 0; i < 40'000; ++i) {
    rig.step(kHover);
    worst_m = std::max(worst_m, (rig.truth(0).p_WB_m - hold_at(0.0).p_WB_m).norm());
  }

  CHECK(rig.pilot(0).state() == FlightState::kFlying);
  CHECK(worst_m < 1.0);
}

TEST_CASE("a vehicle too heavy for its motors gives up on the ground") {
  FlightRig rig{{.masses_kg = {4.0}, .nominal_mass_kg = 1.2}};
  rig.pilot(0).take_off(kAltitude_m);

  run(rig, 10.0, kHover);

  CHECK(rig.pilot(0).failsafe_reason() == FailsafeReason::kNoLiftOff);
  CHECK(rig.on_ground(0));
  CHECK_FALSE(rig.pilot(0).motors_on());
}

}  // namespace
}  // namespace cuscus::flight
