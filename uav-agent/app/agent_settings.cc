#include "uav-agent/app/agent_settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cuscus::agent {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument{"agent configuration: " + what};
  }
}

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

/// For parameters that are never 0.
void take_if_given(double given, double& value) {
  if (given != 0.0) {
    require(positive(given), "a multirotor parameter is not a positive number");
    value = given;
  }
}

void check(const proto::CircleMission& circle) {
  require(positive(circle.radius_m()), "circle.radius_m is not positive");
  require(circle.speed_mps() >= 0.0, "circle.speed_mps is negative");
  require(std::isfinite(circle.spacing_gain()) && circle.spacing_gain() >= 0.0,
          "circle.spacing_gain is negative");
  require(std::isfinite(circle.p_wc_centre_m().x()) && std::isfinite(circle.p_wc_centre_m().y()) &&
              positive(circle.p_wc_centre_m().z()),
          "circle.p_WC_centre_m is not above the ground");
}

}  // namespace

void check(const proto::AgentConfiguration& configuration) {
  require(configuration.fleet_size() > 0, "fleet_size is 0");
  require(configuration.slot() < configuration.fleet_size(), "slot is not below fleet_size");
  require(configuration.control_period_ns() > 0, "control_period_ns is not positive");
  if (configuration.has_circle()) {
    check(configuration.circle());
  }
  require(configuration.neighbour_timeout_ns() > 0, "neighbour_timeout_ns is not positive");
  require(std::isfinite(configuration.motion_capture_noise_m()) &&
              configuration.motion_capture_noise_m() >= 0.0,
          "motion_capture_noise_m is negative");
  require(configuration.beacon_port() <= 65535, "beacon_port is no port");
  require(configuration.telemetry_port() <= 65535, "telemetry_port is no port");
  require(configuration.telemetry_address().empty() || configuration.telemetry_period_ns() > 0,
          "telemetry_period_ns is not positive");
  const bool by_capture =
      configuration.neighbours() == proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE;
  if (by_capture) {
    require(
        static_cast<std::uint32_t>(configuration.slot_nodes().size()) == configuration.fleet_size(),
        "slot_nodes does not name one node per slot");
  } else {
    require(configuration.beacon_period_ns() > 0, "beacon_period_ns is not positive");
  }
}

flight::Airframe airframe(const proto::AgentConfiguration& configuration) {
  flight::Airframe airframe;
  const auto& given = configuration.multirotor();
  take_if_given(given.mass_kg(), airframe.mass_kg);
  take_if_given(given.arm_m(), airframe.arm_m);
  take_if_given(given.thrust_factor(), airframe.thrust_factor);
  take_if_given(given.torque_factor(), airframe.torque_factor);
  if (configuration.has_multirotor()) {
    require(std::isfinite(given.drag_lateral()) && given.drag_lateral() >= 0.0,
            "multirotor.drag_lateral is negative");
    airframe.drag_lateral = given.drag_lateral();
  }
  take_if_given(given.inertia_roll_kgm2(), airframe.inertia_roll_kgm2);
  take_if_given(given.inertia_pitch_kgm2(), airframe.inertia_pitch_kgm2);
  take_if_given(given.inertia_yaw_kgm2(), airframe.inertia_yaw_kgm2);
  take_if_given(given.motor_speed_per_command(), airframe.motor_speed_per_command);
  take_if_given(configuration.gravity_mps2(), airframe.gravity_mps2);
  return airframe;
}

flight::AutopilotParameters autopilot_parameters(const proto::AgentConfiguration& configuration) {
  flight::AutopilotParameters parameters;
  parameters.estimator.gravity_mps2 = airframe(configuration).gravity_mps2;
  // Not below what readings of a moving vehicle are off by because they come late.
  parameters.estimator.position_noise_m =
      std::max(parameters.estimator.position_noise_m, configuration.motion_capture_noise_m());
  return parameters;
}

missions::CircleParameters circle(const proto::AgentConfiguration& configuration) {
  const auto& given = configuration.circle();
  missions::CircleParameters circle;
  if (!configuration.has_circle()) {
    return circle;  // not flown
  }
  circle.p_WC_centre_m = {given.p_wc_centre_m().x(), given.p_wc_centre_m().y(),
                          given.p_wc_centre_m().z()};
  circle.radius_m = given.radius_m();
  circle.speed_mps = given.speed_mps();
  circle.spacing_gain_ps = given.spacing_gain();
  return circle;
}

}  // namespace cuscus::agent
