#include "world/dynamics/quadrotor_fleet.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/unit/world/dynamics/flight.h"

namespace cuscus::world {
namespace {

Eigen::Vector3d inertia_of(const MultirotorParameters& x) {
  return {x.inertia_roll_kgm2, x.inertia_pitch_kgm2, x.inertia_yaw_kgm2};
}

TEST_CASE("without air a vehicle falls as in the textbook") {
  auto fleet = single(without_drag(flair_x4()));
  fleet.set_state(0, {.p_WB_m = {0.0, 0.0, 1000.0}, .v_WB_W_mps = {3.0, -2.0, 5.0}});

  fly(fleet, 2.0);

  // The exact path is a polynomial of degree 2, which Runge-Kutta follows but for rounding.
  const RigidBodyState fallen = fleet.state(0);
  CHECK(fallen.p_WB_m.x() == Approx(6.0).epsilon(1e-12));
  CHECK(fallen.p_WB_m.y() == Approx(-4.0).epsilon(1e-12));
  CHECK(fallen.p_WB_m.z() == Approx(1000.0 + 5.0 * 2.0 - 0.5 * 9.81 * 4.0).epsilon(1e-12));
  CHECK(fallen.v_WB_W_mps.z() == Approx(5.0 - 9.81 * 2.0).epsilon(1e-12));
}

TEST_CASE("linear drag bends the fall as its closed form says") {
  MultirotorParameters draggy = flair_x4();
  draggy.drag_vertical_Nspm = 0.5;
  auto fleet = single(draggy);
  fleet.set_state(0, {.p_WB_m = {0.0, 0.0, 1000.0}, .v_WB_W_mps = {8.0, 0.0, 0.0}});

  const double t_s = 3.0;
  fly(fleet, t_s);

  // v_z(t) = -(m g / f) (1 - exp(-f t / m)), v_x(t) = v_x(0) exp(-f t / m).
  const RigidBodyState fallen = fleet.state(0);
  const double vertical = 0.5 / 1.2;
  const double lateral = 0.4 / 1.2;
  CHECK(fallen.v_WB_W_mps.z() ==
        Approx(-9.81 / vertical * (1.0 - std::exp(-vertical * t_s))).epsilon(1e-10));
  CHECK(fallen.v_WB_W_mps.x() == Approx(8.0 * std::exp(-lateral * t_s)).epsilon(1e-10));
}

TEST_CASE("terminal speed is weight over drag") {
  MultirotorParameters draggy = flair_x4();
  draggy.drag_vertical_Nspm = 2.0;
  auto fleet = single(draggy);
  fleet.set_state(0, in_the_air());

  fly(fleet, 30.0);  // 50 time constants of m / f = 0.6 s

  CHECK(fleet.state(0).v_WB_W_mps.z() == Approx(-1.2 * 9.81 / 2.0).epsilon(1e-9));
}

TEST_CASE("a tilted vehicle that holds its height ends at the speed where drag balances thrust") {
  const double tilt_rad = 10.0 * std::numbers::pi / 180.0;
  const MultirotorParameters x4 = flair_x4();
  auto fleet = single(x4);
  RigidBodyState tilted = in_the_air();
  tilted.q_WB = Eigen::AngleAxisd{tilt_rad, Eigen::Vector3d::UnitY()};  // nose down: forwards
  fleet.set_state(0, tilted);
  const double u = hover_command(x4, kGravity_mps2) / std::sqrt(std::cos(tilt_rad));
  fleet.set_commands(0, {u, u, u, u});

  fly(fleet, 90.0);  // 30 time constants of m / f = 3 s

  const RigidBodyState end = fleet.state(0);
  CHECK(end.v_WB_W_mps.x() == Approx(1.2 * 9.81 * std::tan(tilt_rad) / 0.4).epsilon(1e-9));
  CHECK(std::abs(end.v_WB_W_mps.z()) < 1e-9);
}

TEST_CASE("the hover command holds the X4 where it is, whatever its mass") {
  // Computed apart from the code, from sqrt(m g / (4 k_mot)) / 86.
  const auto [mass_kg, command] = GENERATE(
      table<double, double>({{1.0, 0.57585}, {1.2, 0.63081}, {1.5, 0.70527}, {2.0, 0.81437}}));
  CAPTURE(mass_kg);
  const double u = hover_command(flair_x4(mass_kg), kGravity_mps2);
  auto fleet = single(flair_x4(mass_kg));
  fleet.set_state(0, in_the_air(10.0));
  fleet.set_commands(0, {u, u, u, u});

  fly(fleet, 10.0);

  CHECK(u == Approx(command).margin(6e-6));
  CHECK(fleet.state(0).p_WB_m.z() == Approx(10.0).margin(1e-10));
  CHECK(fleet.specific_force_mps2(0).z() == Approx(9.81).epsilon(1e-12));
}

TEST_CASE("at the same command a heavier vehicle climbs more slowly") {
  const std::vector<MultirotorParameters> vehicles{flair_x4(1.0), flair_x4(1.5), flair_x4(2.0)};
  QuadrotorFleet fleet{vehicles, kEarth};
  for (std::size_t i = 0; i < 3; ++i) {
    fleet.set_state(i, in_the_air());
    fleet.set_commands(i, {1.0, 1.0, 1.0, 1.0});
  }

  fleet.step();

  // Four rotors at full speed lift 4 k 86^2 = 29.584 N.
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(fleet.state(i).v_WB_W_mps.z() ==
          Approx((29.584 / vehicles[i].mass_kg - 9.81) * kStep_s).epsilon(1e-4));
  }
}

TEST_CASE("more thrust on one side turns the vehicle as FLU axes say") {
  struct Case {
    RotorCommands commands;
    Eigen::Vector3d turn;  // sign of each rate
  };
  const auto [commands, turn] =
      GENERATE(Case{{0.7, 0.6, 0.7, 0.6}, {+1, 0, 0}},  // left stronger: left side up
               Case{{0.6, 0.6, 0.7, 0.7}, {0, +1, 0}},  // rear stronger: nose down
               Case{{0.6, 0.7, 0.7, 0.6}, {0, 0, +1}},  // clockwise rotors faster: nose left
               Case{{0.7, 0.6, 0.6, 0.7}, {0, 0, -1}});
  auto fleet = single(flair_x4());
  fleet.set_state(0, in_the_air());
  fleet.set_commands(0, commands);

  fleet.step();

  const Eigen::Vector3d w = fleet.state(0).w_WB_B_radps;
  for (Eigen::Index i = 0; i < 3; ++i) {
    CAPTURE(i, w[i]);
    CHECK((std::abs(w[i]) > 1e-12) == (turn[i] != 0.0));
    CHECK(w[i] * turn[i] >= 0.0);
  }
}

TEST_CASE("angular accelerations are torque over inertia") {
  auto fleet = single(flair_x4());
  fleet.set_state(0, in_the_air());
  fleet.set_commands(0, {0.7, 0.6, 0.7, 0.6});

  fleet.step();

  // tau_x = a / sqrt 2 * k * 2 (60.2^2 - 51.6^2) with a = 0.2, k = 0.001, J_x = 0.006.
  const double torque_Nm = 0.2 / std::sqrt(2.0) * 0.001 * 2.0 * (60.2 * 60.2 - 51.6 * 51.6);
  CHECK(fleet.state(0).w_WB_B_radps.x() == Approx(torque_Nm / 0.006 * kStep_s).epsilon(1e-9));

  fleet.set_state(0, in_the_air());
  fleet.set_commands(0, {0.6, 0.7, 0.7, 0.6});
  fleet.step();
  const double yaw_Nm = 0.001 * 2.0 * (60.2 * 60.2 - 51.6 * 51.6);
  CHECK(fleet.state(0).w_WB_B_radps.z() == Approx(yaw_Nm / 0.1 * kStep_s).epsilon(1e-9));
}

TEST_CASE("a tumble without torque keeps its energy and its angular momentum") {
  MultirotorParameters uneven = without_drag(flair_x4());
  uneven.inertia_pitch_kgm2 = 0.02;  // three different moments: the general, chaotic-looking case
  auto fleet = single(uneven, kSpace);
  RigidBodyState tumbling = in_the_air();
  tumbling.w_WB_B_radps = {1.0, 6.0, 0.5};  // near the unstable middle axis
  fleet.set_state(0, tumbling);
  const Eigen::Vector3d inertia = inertia_of(uneven);
  const Eigen::Vector3d momentum = inertia.cwiseProduct(tumbling.w_WB_B_radps);
  const double energy_J = 0.5 * tumbling.w_WB_B_radps.dot(momentum);

  for (int second = 0; second < 5; ++second) {
    fly(fleet, 1.0);

    const RigidBodyState now = fleet.state(0);
    const Eigen::Vector3d momentum_B = inertia.cwiseProduct(now.w_WB_B_radps);
    CHECK(0.5 * now.w_WB_B_radps.dot(momentum_B) == Approx(energy_J).epsilon(1e-9));
    CHECK(momentum_B.norm() == Approx(momentum.norm()).epsilon(1e-9));
    // In the world its direction stays too; that also needs the attitude to be right.
    CHECK((now.q_WB * momentum_B - momentum).norm() < 1e-8 * momentum.norm());
    CHECK(now.q_WB.norm() == Approx(1.0).epsilon(1e-15));
  }
  CHECK((fleet.state(0).w_WB_B_radps - tumbling.w_WB_B_radps).norm() > 1.0);
}

TEST_CASE("a disc that spins and is nudged precesses at the rate that Euler's equations give") {
  // J_x = J_y: w_x and w_y turn at (J_z - J_x) / J_x * w_z in the body frame.
  auto fleet = single(without_drag(flair_x4()), kSpace);
  RigidBodyState spinning = in_the_air();
  spinning.w_WB_B_radps = {0.1, 0.0, 0.5};
  fleet.set_state(0, spinning);

  const double t_s = 0.4;
  fly(fleet, t_s);

  const double angle_rad = (0.1 - 0.006) / 0.006 * 0.5 * t_s;
  const Eigen::Vector3d w = fleet.state(0).w_WB_B_radps;
  CHECK(w.x() == Approx(0.1 * std::cos(angle_rad)).margin(1e-9));
  CHECK(w.y() == Approx(0.1 * std::sin(angle_rad)).margin(1e-9));
  CHECK(w.z() == 0.5);
}

TEST_CASE("half the step leaves a sixteenth of the error") {
  const auto end_of = [](double step_s) {
    auto fleet = single(flair_x4(), PlantSettings{.step_s = step_s, .gravity_mps2 = 9.81});
    RigidBodyState start = in_the_air();
    start.v_WB_W_mps = {2.0, 1.0, 0.0};
    start.w_WB_B_radps = {0.5, -1.0, 2.0};
    fleet.set_state(0, start);
    fleet.set_commands(0, {0.66, 0.65, 0.655, 0.645});
    fly(fleet, 1.0, step_s);
    return fleet.state(0);
  };
  const double step_s = 0.01;

  const RigidBodyState exact = end_of(step_s / 32);
  const RigidBodyState coarse = end_of(step_s);
  const RigidBodyState fine = end_of(step_s / 2);

  const auto distance = [](const RigidBodyState& a, const RigidBodyState& b) {
    return (a.p_WB_m - b.p_WB_m).norm() + a.q_WB.angularDistance(b.q_WB) +
           (a.w_WB_B_radps - b.w_WB_B_radps).norm();
  };
  // Not exactly 16: terms of the next order are in both.
  CHECK(distance(coarse, exact) > 1e-9);  // far above rounding, so that the ratio means something
  CHECK(distance(coarse, exact) / distance(fine, exact) == Approx(16.0).margin(3.0));
}

TEST_CASE("a vehicle moves the same alone and in a fleet, bit for bit") {
  constexpr std::size_t kVehicles = 21;  // two whole blocks and a part
  std::vector<MultirotorParameters> parameters;
  std::vector<RigidBodyState> starts;
  std::vector<RotorCommands> commands;
  for (std::size_t i = 0; i < kVehicles; ++i) {
    const double x = 0.01 * static_cast<double>(i);
    parameters.push_back(flair_x4(1.0 + 5.0 * x));
    RigidBodyState start = in_the_air(i % 3 == 0 ? 0.0 : 2.0);  // some land, some stand
    start.w_WB_B_radps = i % 3 == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d{x, -x, 3.0 * x};
    starts.push_back(start);
    commands.push_back({0.6 + x, 0.6 + 0.9 * x, 0.6 + 1.1 * x, 0.6 + x});
  }
  QuadrotorFleet fleet{parameters, kEarth};
  for (std::size_t i = 0; i < kVehicles; ++i) {
    fleet.set_state(i, starts[i]);
    fleet.set_commands(i, commands[i]);
  }
  fly(fleet, 1.5);

  for (std::size_t i = 0; i < kVehicles; ++i) {
    auto alone = single(parameters[i]);
    alone.set_state(0, starts[i]);
    alone.set_commands(0, commands[i]);
    fly(alone, 1.5);

    CAPTURE(i);
    CHECK(alone.state(0).p_WB_m == fleet.state(i).p_WB_m);
    CHECK(alone.state(0).v_WB_W_mps == fleet.state(i).v_WB_W_mps);
    CHECK(alone.state(0).q_WB.coeffs() == fleet.state(i).q_WB.coeffs());
    CHECK(alone.state(0).w_WB_B_radps == fleet.state(i).w_WB_B_radps);
    CHECK(alone.on_ground(0) == fleet.on_ground(i));
  }
}

TEST_CASE("an accelerometer feels drag, and nothing in free fall") {
  auto fleet = single(flair_x4());
  RigidBodyState flying = in_the_air();
  flying.q_WB = Eigen::AngleAxisd{std::numbers::pi / 2, Eigen::Vector3d::UnitZ()};  // nose north
  fleet.set_state(0, flying);

  CHECK(fleet.specific_force_mps2(0).norm() == 0.0);

  flying.v_WB_W_mps = {3.0, 0.0, 0.0};  // to its right
  fleet.set_state(0, flying);
  // Drag pushes west, which is the vehicle's left, by 0.4 * 3 / 1.2 m/s^2.
  CHECK((fleet.specific_force_mps2(0) - Eigen::Vector3d{0.0, 1.0, 0.0}).norm() < 1e-12);
}

TEST_CASE("parameters that no vehicle has are refused by name") {
  MultirotorParameters impossible = flair_x4();
  impossible.mass_kg = 0.0;
  CHECK_THROWS_WITH(single(impossible), Catch::Contains("mass_kg"));
  impossible = flair_x4();
  impossible.drag_lateral_Nspm = std::nan("");
  CHECK_THROWS_WITH(single(impossible), Catch::Contains("drag_lateral"));
}

}  // namespace
}  // namespace cuscus::world
