#include "uav-agent/flight/mixer.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/random/counter_stream.h"
#include "world/dynamics/rotor_wrench.h"

namespace cuscus::flight {
namespace {

constexpr double kTorqueTolerance_Nm = 1e-9;

void check_wrench(const Wrench& got, const Wrench& expected) {
  CHECK(got.thrust_N == Approx(expected.thrust_N));
  CHECK((got.torque_B_Nm - expected.torque_B_Nm).norm() < kTorqueTolerance_Nm);
}

TEST_CASE("what the mixer commands does what was asked for") {
  const Mixer mixer{Airframe{}, 0.0};
  const random::CounterStream stream{3, 1};

  for (std::uint64_t i = 0; i < 1000; ++i) {
    // Each motor stays within 0 ... 7.4 N: 3 N -/+ 0.5 / 0.57 twice -/+ 0.25.
    const Wrench wanted{
        .thrust_N = 10.0 + 4.0 * stream.uniform(4 * i),
        .torque_B_Nm = {stream.uniform(4 * i + 1) - 0.5, stream.uniform(4 * i + 2) - 0.5,
                        2.0 * stream.uniform(4 * i + 3) - 1.0}};
    check_wrench(mixer.wrench(mixer.commands(wanted)), wanted);
  }
}

TEST_CASE("the mixer and the simulated rotors agree on levers and directions") {
  const Mixer mixer{Airframe{}, 0.0};
  const random::CounterStream stream{4, 1};

  for (std::uint64_t i = 0; i < 100; ++i) {
    const MotorCommands commands{stream.uniform(4 * i), stream.uniform(4 * i + 1),
                                 stream.uniform(4 * i + 2), stream.uniform(4 * i + 3)};
    const auto world = world::rotor_wrench(world::flair_x4(), commands);
    check_wrench(mixer.wrench(commands),
                 {.thrust_N = world.thrust_N,
                  .torque_B_Nm = {world.torque_x_Nm, world.torque_y_Nm, world.torque_z_Nm}});
  }
}

TEST_CASE("hovering takes the command that FL-AIR's numbers give") {
  const Mixer mixer{Airframe{}, 0.0};

  const MotorCommands commands = mixer.commands({.thrust_N = 1.2 * 9.81});

  // sqrt(m g / (4 k_mot)) / 86
  const double expected = std::sqrt(1.2 * 9.81 / (4.0 * 0.001)) / 86.0;
  CHECK(expected == Approx(0.631).margin(0.0005));
  for (const double command : commands) {
    CHECK(command == Approx(expected));
  }
}

TEST_CASE("yaw is given up before thrust, roll and pitch") {
  const Mixer mixer{Airframe{}, 0.0};
  const Wrench wanted{.thrust_N = 12.0, .torque_B_Nm = {0.4, -0.3, 50.0}};

  const Wrench got = mixer.wrench(mixer.commands(wanted));

  CHECK(got.thrust_N == Approx(12.0));
  CHECK(got.torque_B_Nm.x() == Approx(0.4));
  CHECK(got.torque_B_Nm.y() == Approx(-0.3));
  CHECK(got.torque_B_Nm.z() > 0.0);
  CHECK(got.torque_B_Nm.z() < 50.0);
}

TEST_CASE("thrust is given up before roll and pitch") {
  const Airframe airframe;
  const Mixer mixer{airframe, 0.0};

  SECTION("too much of it is asked for") {
    const Wrench got =
        mixer.wrench(mixer.commands({.thrust_N = 99.0, .torque_B_Nm = {1.0, 0.5, 0.0}}));
    CHECK(got.torque_B_Nm.x() == Approx(1.0));
    CHECK(got.torque_B_Nm.y() == Approx(0.5));
    CHECK(got.thrust_N < 4.0 * airframe.motor_thrust_max_N());
  }
  SECTION("none of it is asked for") {
    const Wrench got =
        mixer.wrench(mixer.commands({.thrust_N = 0.0, .torque_B_Nm = {1.0, 0.5, 0.0}}));
    CHECK(got.torque_B_Nm.x() == Approx(1.0));
    CHECK(got.torque_B_Nm.y() == Approx(0.5));
    CHECK(got.thrust_N > 0.0);
  }
}

TEST_CASE("torques beyond reach keep their direction") {
  const Mixer mixer{Airframe{}, 0.1};

  const Wrench got =
      mixer.wrench(mixer.commands({.thrust_N = 12.0, .torque_B_Nm = {30.0, 60.0, 0.0}}));

  CHECK(got.torque_B_Nm.x() > 0.0);
  CHECK(got.torque_B_Nm.y() == Approx(2.0 * got.torque_B_Nm.x()));
}

TEST_CASE("commands stay within the motors' range whatever is asked for") {
  const Mixer mixer{Airframe{}, 0.1};
  const random::CounterStream stream{5, 1};

  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto draw = [&](std::uint64_t k) { return 200.0 * (stream.uniform(4 * i + k) - 0.5); };
    const MotorCommands commands =
        mixer.commands({.thrust_N = draw(0), .torque_B_Nm = {draw(1), draw(2), draw(3)}});
    for (const double command : commands) {
      CHECK(command >= 0.1 - 1e-12);
      CHECK(command <= 1.0 + 1e-12);
    }
  }
}

}  // namespace
}  // namespace cuscus::flight
