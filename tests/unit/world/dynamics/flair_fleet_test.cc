#include "world/dynamics/flair_fleet.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/world/dynamics/flight.h"

namespace cuscus::world {
namespace {

// One test for each way in which FL-AIR's plant differs; docs/models/x4.md has the list.

TEST_CASE("FL-AIR's rates feel the coupling of the axes with the wrong sign") {
  RigidBodyState turning = in_the_air();
  turning.w_WB_B_radps = {0.0, 1.0, 2.0};
  auto ours = single(flair_x4());
  auto theirs = single<FlairFleet>(flair_x4());
  ours.set_state(0, turning);
  theirs.set_state(0, turning);

  ours.step();
  theirs.step();

  // Euler: J_x dw_x/dt = (J_y - J_z) w_y w_z.
  const double correct_radps2 = (0.006 - 0.1) * 1.0 * 2.0 / 0.006;
  CHECK(ours.state(0).w_WB_B_radps.x() == Approx(correct_radps2 * kStep_s).epsilon(1e-2));
  CHECK(theirs.state(0).w_WB_B_radps.x() == Approx(-correct_radps2 * kStep_s).epsilon(1e-12));
}

TEST_CASE("FL-AIR's yaw knows no coupling at all") {
  MultirotorParameters uneven = flair_x4();
  uneven.inertia_pitch_kgm2 = 0.02;
  RigidBodyState turning = in_the_air();
  turning.w_WB_B_radps = {1.0, 2.0, 0.0};
  auto ours = single(uneven);
  auto theirs = single<FlairFleet>(uneven);
  ours.set_state(0, turning);
  theirs.set_state(0, turning);

  ours.step();
  theirs.step();

  CHECK(ours.state(0).w_WB_B_radps.z() ==
        Approx((0.006 - 0.02) * 1.0 * 2.0 / 0.1 * kStep_s).epsilon(1e-2));
  CHECK(theirs.state(0).w_WB_B_radps.z() == 0.0);
}

TEST_CASE("FL-AIR's vertical drag pushes, its lateral drag brakes") {
  MultirotorParameters draggy = flair_x4();
  draggy.drag_vertical_Nspm = 0.6;
  RigidBodyState falling = in_the_air();
  falling.v_WB_W_mps = {2.0, 0.0, -3.0};
  auto theirs = single<FlairFleet>(draggy, kSpace);
  auto ours = single(draggy, kSpace);
  theirs.set_state(0, falling);
  ours.set_state(0, falling);

  theirs.step();
  ours.step();

  // f v / m = 1.5 m/s^2 along z, 0.667 m/s^2 along x. The tolerance is that of second differences
  // of a height of 1000 m.
  CHECK((theirs.state(0).v_WB_W_mps.z() + 3.0) / kStep_s == Approx(-1.5).epsilon(1e-5));
  CHECK((ours.state(0).v_WB_W_mps.z() + 3.0) / kStep_s == Approx(+1.5).epsilon(1e-2));
  CHECK((theirs.state(0).v_WB_W_mps.x() - 2.0) / kStep_s == Approx(-0.8 / 1.2).epsilon(1e-5));
  CHECK(theirs.specific_force_mps2(0).z() < 0.0);
  CHECK(ours.specific_force_mps2(0).z() > 0.0);
}

TEST_CASE("FL-AIR's attitude turns by the new rates, its thrust by the new attitude") {
  auto theirs = single<FlairFleet>(without_drag(flair_x4()), kSpace);
  theirs.set_state(0, in_the_air());
  theirs.set_commands(0, {0.7, 0.6, 0.7, 0.6});  // rolls to the right

  theirs.step();

  // From rest: w = h tau / J; the half angle is atan(h w / 2), since q is only normalised; the
  // thrust leans by that angle already in the first step. Runge-Kutta would have half of it.
  const double torque_Nm = 0.2 / std::sqrt(2.0) * 0.001 * 2.0 * (60.2 * 60.2 - 51.6 * 51.6);
  const double thrust_N = 0.001 * 2.0 * (60.2 * 60.2 + 51.6 * 51.6);
  const double rate_radps = kStep_s * torque_Nm / 0.006;
  const double angle_rad = 2.0 * std::atan(0.5 * kStep_s * rate_radps);
  const RigidBodyState after = theirs.state(0);
  CHECK(after.w_WB_B_radps.x() == Approx(rate_radps).epsilon(1e-12));
  CHECK(2.0 * std::atan2(after.q_WB.x(), after.q_WB.w()) == Approx(angle_rad).epsilon(1e-9));
  CHECK(after.v_WB_W_mps.y() ==
        Approx(-kStep_s * thrust_N / 1.2 * std::sin(angle_rad)).epsilon(1e-9));
}

TEST_CASE("FL-AIR's position is a second difference, so that a fall is half a step ahead") {
  auto theirs = single<FlairFleet>(without_drag(flair_x4()));
  theirs.set_state(0, in_the_air());

  fly(theirs, 1.0);

  // p[k] = p[0] - g h^2 k (k + 1) / 2 and v = (p[k] - p[k-1]) / h = -g h k: v is exact, the fall
  // is longer than g t^2 / 2 by g h t / 2 = 4.9 mm.
  CHECK(theirs.state(0).p_WB_m.z() == Approx(1000.0 - 0.5 * 9.81 * (1.0 + kStep_s)).epsilon(1e-10));
  CHECK(theirs.state(0).v_WB_W_mps.z() == Approx(-9.81).epsilon(1e-7));
}

TEST_CASE("FL-AIR's error shrinks only as fast as the step") {
  const auto height_after_a_second = [](double step_s) {
    auto plant =
        single<FlairFleet>(flair_x4(), PlantSettings{.step_s = step_s, .gravity_mps2 = 9.81});
    plant.set_state(0, in_the_air());
    fly(plant, 1.0, step_s);
    return plant.state(0).p_WB_m.z();
  };

  const double exact = height_after_a_second(0.01 / 64);
  const double ratio =
      (height_after_a_second(0.01) - exact) / (height_after_a_second(0.005) - exact);

  CHECK(ratio == Approx(2.0).margin(0.1));
}

TEST_CASE("FL-AIR's vehicle turns the same way as ours from the same commands") {
  const auto commands =
      GENERATE(RotorCommands{0.7, 0.6, 0.7, 0.6}, RotorCommands{0.6, 0.6, 0.7, 0.7},
               RotorCommands{0.6, 0.7, 0.7, 0.6});
  auto ours = single(flair_x4());
  auto theirs = single<FlairFleet>(flair_x4());
  RigidBodyState start = in_the_air();
  start.q_WB = Eigen::AngleAxisd{0.7, Eigen::Vector3d::UnitZ()};
  for (Plant* const plant : {static_cast<Plant*>(&ours), static_cast<Plant*>(&theirs)}) {
    plant->set_state(0, start);
    plant->set_commands(0, commands);
    fly(*plant, 0.1);
  }

  // Apart by the first-order error of its integrator only.
  CHECK((ours.state(0).w_WB_B_radps - theirs.state(0).w_WB_B_radps).norm() <
        0.01 * ours.state(0).w_WB_B_radps.norm());
  CHECK(ours.state(0).q_WB.angularDistance(theirs.state(0).q_WB) < 0.05);
  CHECK((ours.state(0).p_WB_m - theirs.state(0).p_WB_m).norm() < 0.01);
}

TEST_CASE("FL-AIR's ground freezes the position but not the attitude") {
  auto theirs = single<FlairFleet>(flair_x4());
  theirs.set_state(0, {.p_WB_m = {4.0, 5.0, 0.0}});
  theirs.set_commands(0, {0.4, 0.3, 0.4, 0.3});

  fly(theirs, 0.05);

  CHECK(theirs.on_ground(0));
  CHECK(theirs.state(0).p_WB_m == Eigen::Vector3d{4.0, 5.0, 0.0});
  CHECK(theirs.state(0).v_WB_W_mps.isZero(0.0));
  CHECK(theirs.state(0).w_WB_B_radps.x() > 0.1);
}

TEST_CASE("FL-AIR's vehicle takes off, hovers and lands") {
  const double hover = hover_command(flair_x4(), kGravity_mps2);
  auto theirs = single<FlairFleet>(flair_x4());
  theirs.set_commands(0, {0.99 * hover, 0.99 * hover, 0.99 * hover, 0.99 * hover});
  fly(theirs, 0.5);
  CHECK(theirs.on_ground(0));

  theirs.set_commands(0, {1.1 * hover, 1.1 * hover, 1.1 * hover, 1.1 * hover});
  fly(theirs, 1.0);
  CHECK_FALSE(theirs.on_ground(0));
  CHECK(theirs.state(0).p_WB_m.z() == Approx(0.5 * 9.81 * 0.21).epsilon(0.01));

  theirs.set_commands(0, {});
  fly(theirs, 2.0);
  CHECK(theirs.on_ground(0));
  CHECK(theirs.state(0).p_WB_m.z() == 0.0);
}

}  // namespace
}  // namespace cuscus::world
