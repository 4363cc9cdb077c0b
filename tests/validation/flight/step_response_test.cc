// Steps of one metre on the real plant, in simulated time.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/support/flight_rig.h"

namespace cuscus::tests {
namespace {

struct StepResponse {
  double overshoot = 0.0;  ///< Share of the step.
  double settled_s = 0.0;  ///< Within 5 % of the step from then on.
  double rise_s = 0.0;     ///< 10 % to 90 %.
};

StepResponse response(const FlightRig::Settings& settings, const Eigen::Vector3d& step_m) {
  FlightRig rig{settings};
  flight::Setpoint setpoint;
  setpoint.p_WB_m = {0.0, 0.0, 5.0};
  const auto guidance = [&](std::size_t, SimTime) { return setpoint; };
  rig.pilot(0).take_off(5.0);
  for (int i = 0; i < 25'000; ++i) {
    rig.step(guidance);
  }
  const Eigen::Vector3d before_m = rig.truth(0).p_WB_m;
  setpoint.p_WB_m += step_m;
  StepResponse result;
  std::optional<double> tenth_s;
  std::optional<double> ninth_s;
  for (int i = 1; i <= 15'000; ++i) {
    rig.step(guidance);
    const double t_s = 0.001 * i;
    const double share = (rig.truth(0).p_WB_m - before_m).dot(step_m.normalized()) / step_m.norm();
    tenth_s = tenth_s || share < 0.1 ? tenth_s : t_s;
    ninth_s = ninth_s || share < 0.9 ? ninth_s : t_s;
    result.overshoot = std::max(result.overshoot, share - 1.0);
    if (std::abs(share - 1.0) > 0.05) {
      result.settled_s = t_s;
    }
  }
  REQUIRE(rig.pilot(0).state() == flight::FlightState::kFlying);
  result.rise_s = ninth_s.value_or(std::numeric_limits<double>::infinity()) - tenth_s.value_or(0.0);
  return result;
}

TEST_CASE("a step of one metre settles with little overshoot, for all masses of the paper") {
  const double mass_kg = GENERATE(1.0, 1.2, 1.5, 2.0);
  const Eigen::Vector3d step_m =
      GENERATE(Eigen::Vector3d{1.0, 0.0, 0.0}, Eigen::Vector3d{0.0, -1.0, 0.0},
               Eigen::Vector3d{0.0, 0.0, 1.0}, Eigen::Vector3d{0.0, 0.0, -1.0});

  const StepResponse got = response({.masses_kg = {mass_kg}}, step_m);

  CAPTURE(mass_kg, step_m.transpose(), got.overshoot, got.settled_s, got.rise_s);
  // In the plane, g kp = 1.96 1/s^2 and g kd = 1.96 1/s with drag f / m in addition: an ideal
  // second order of 1.4 rad/s and damping 0.77 to 0.84 overshoots 2 % and settles in about 2.5 s;
  // the tilt loop's lag adds to both. Vertically 2 rad/s, damping 0.85, and an integral that
  // overshoots.
  CHECK(got.overshoot < 0.2);
  CHECK(got.settled_s < 6.0);
  CHECK(got.rise_s < 2.5);
  CHECK(got.rise_s > 0.3);
}

}  // namespace
}  // namespace cuscus::tests
