#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/unit/world/dynamics/flight.h"

namespace cuscus::world {
namespace {

TEST_CASE("a vehicle on the ground rests until its thrust exceeds its weight") {
  const double hover = hover_command(flair_x4(), kGravity_mps2);
  auto fleet = single(flair_x4());
  fleet.set_state(0, {.p_WB_m = {4.0, 5.0, 0.0}});
  CHECK(fleet.on_ground(0));

  SECTION("with stopped motors") {}
  SECTION("just below the hover command") {
    fleet.set_commands(0, RotorCommands{hover, hover, hover, hover * 0.9999});
  }
  SECTION("with torques that would turn it over in the air") {
    fleet.set_commands(0, RotorCommands{0.8, 0.2, 0.8, 0.2});
  }
  fly(fleet, 2.0);

  CHECK(fleet.on_ground(0));
  CHECK(fleet.state(0).p_WB_m == Eigen::Vector3d{4.0, 5.0, 0.0});
  CHECK(fleet.state(0).v_WB_W_mps.isZero(0.0));
  CHECK(fleet.state(0).w_WB_B_radps.isZero(0.0));
  CHECK(fleet.specific_force_mps2(0) == Eigen::Vector3d{0.0, 0.0, 9.81});
}

TEST_CASE("a vehicle takes off when its thrust exceeds its weight") {
  const double u = 1.01 * hover_command(flair_x4(), kGravity_mps2);
  auto fleet = single(without_drag(flair_x4()));
  fleet.set_commands(0, {u, u, u, u});

  fly(fleet, 1.0);

  // Thrust grows with the square of the command: a = g (1.01^2 - 1).
  CHECK_FALSE(fleet.on_ground(0));
  CHECK(fleet.state(0).p_WB_m.z() == Approx(0.5 * 9.81 * (1.01 * 1.01 - 1.0)).epsilon(1e-9));
}

TEST_CASE("a vehicle that falls does not sink, bounce or slide, and stands level") {
  auto fleet = single(flair_x4());
  const double yaw_rad = 2.0;
  RigidBodyState falling{.p_WB_m = {1.0, 2.0, 0.5}, .v_WB_W_mps = {3.0, 0.0, -1.0}};
  falling.q_WB = Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()} *
                 Eigen::AngleAxisd{0.3, Eigen::Vector3d::UnitX()};
  falling.w_WB_B_radps = {0.1, 0.0, 0.0};
  fleet.set_state(0, falling);

  bool sank = false;
  for (int i = 0; i < 1000; ++i) {
    fleet.step();
    sank = sank || fleet.state(0).p_WB_m.z() < 0.0;
  }
  const RigidBodyState landed = fleet.state(0);
  fly(fleet, 1.0);

  CHECK_FALSE(sank);
  CHECK(fleet.on_ground(0));
  CHECK(landed.p_WB_m.z() == 0.0);
  CHECK(landed.v_WB_W_mps.isZero(0.0));
  CHECK(landed.w_WB_B_radps.isZero(0.0));
  CHECK((landed.q_WB * Eigen::Vector3d::UnitZ()).z() == Approx(1.0));
  // The turn about the vertical of the falling attitude, whose tilt was about 0.3 rad.
  CHECK(std::abs(2.0 * std::atan2(landed.q_WB.z(), landed.q_WB.w()) - yaw_rad) < 1e-3);
  CHECK(fleet.state(0).p_WB_m == landed.p_WB_m);
}

TEST_CASE("a vehicle that falls on its back lies there, whatever its motors do") {
  auto fleet = single(flair_x4());
  RigidBodyState falling = in_the_air(0.2);
  falling.q_WB = Eigen::AngleAxisd{3.0, Eigen::Vector3d::UnitX()};
  fleet.set_state(0, falling);
  fly(fleet, 1.0);
  const RigidBodyState landed = fleet.state(0);
  fleet.set_commands(0, {1.0, 1.0, 1.0, 1.0});
  fly(fleet, 1.0);

  CHECK(fleet.on_ground(0));
  CHECK(landed.q_WB.angularDistance(falling.q_WB) < 1e-12);
  CHECK(fleet.state(0).p_WB_m == landed.p_WB_m);
}

TEST_CASE("what was put in the air is not on the ground") {
  auto fleet = single(flair_x4());
  fleet.set_state(0, in_the_air(1.0));

  CHECK_FALSE(fleet.on_ground(0));
  fly(fleet, 1.0);
  CHECK(fleet.on_ground(0));  // a fall of 1 m takes 0.45 s
}

}  // namespace
}  // namespace cuscus::world
