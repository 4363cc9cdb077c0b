#include "uav-agent/flight/cascade.h"

#include <algorithm>
#include <cmath>

namespace cuscus::flight {

bool Setpoint::is_finite() const {
  return p_WB_m.allFinite() && v_WB_mps.allFinite() && a_WB_mps2.allFinite() &&
         std::isfinite(yaw_rad);
}

Eigen::Vector3d euler_angles(const Eigen::Quaterniond& q) {
  return {std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()),
                     1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y())),
          std::asin(std::clamp(2.0 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0)),
          std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                     1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()))};
}

double tilt(const Eigen::Quaterniond& q) {
  return std::acos(std::clamp(1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()), -1.0, 1.0));
}

Cascade::Cascade(const Airframe& airframe, const CascadeGains& gains)
    : airframe_{airframe},
      gains_{gains},
      mixer_{airframe, gains.command_min},
      vertical_{gains.vertical} {}

MotorCommands Cascade::step(const VehicleEstimate& estimate, const Setpoint& setpoint,
                            double dt_s) {
  const Eigen::Vector3d error_m = setpoint.p_WB_m - estimate.p_WB_m;
  const Eigen::Vector3d rate_mps = setpoint.v_WB_mps - estimate.v_WB_mps;
  const double g = airframe_.gravity_mps2;
  const double drag_ps = airframe_.drag_lateral / airframe_.mass_kg;
  const Eigen::Vector2d feed_forward =
      setpoint.a_WB_mps2.head<2>() + drag_ps * setpoint.v_WB_mps.head<2>();
  Eigen::Vector2d a_mps2 = g * (gains_.horizontal_kp_radpm * error_m.head<2>() +
                                gains_.horizontal_kd_rads_pm * rate_mps.head<2>()) +
                           feed_forward;
  const double limit_mps2 = g * std::tan(gains_.tilt_limit_rad);
  if (const double norm = a_mps2.norm(); norm > limit_mps2) {
    a_mps2 *= limit_mps2 / norm;
  }
  const double vertical_mps2 =
      setpoint.a_WB_mps2.z() + vertical_.step(error_m.z(), rate_mps.z(), dt_s);

  // The direction of thrust in the frame that has the vehicle's yaw and is level.
  const double yaw_rad = euler_angles(estimate.q_WB).z();
  const double forward_mps2 = std::cos(yaw_rad) * a_mps2.x() + std::sin(yaw_rad) * a_mps2.y();
  const double left_mps2 = -std::sin(yaw_rad) * a_mps2.x() + std::cos(yaw_rad) * a_mps2.y();
  // Tilt is taken against g, not against g plus the vertical acceleration, as FL-AIR does: a lift
  // command must not change the tilt.
  const double pitch_rad = std::atan2(forward_mps2, g);
  const double roll_rad = -std::atan2(left_mps2, std::hypot(g, forward_mps2));
  return step(estimate, AttitudeSetpoint{.roll_rad = roll_rad,
                                         .pitch_rad = pitch_rad,
                                         .yaw_rad = setpoint.yaw_rad,
                                         .thrust_mps2 = g + vertical_mps2});
}

MotorCommands Cascade::step(const VehicleEstimate& estimate,
                            const AttitudeSetpoint& setpoint) const {
  const Eigen::Vector3d angles_rad = euler_angles(estimate.q_WB);
  const Eigen::Vector3d& rate_radps = estimate.angular_rate_B_radps;
  const double roll_radps2 =
      nested_saturation(setpoint.roll_rad, angles_rad.x(), rate_radps.x(), gains_.tilt);
  const double pitch_radps2 =
      nested_saturation(setpoint.pitch_rad, angles_rad.y(), rate_radps.y(), gains_.tilt);
  const double yaw_error_rad =
      std::remainder(setpoint.yaw_rad - angles_rad.z(), 2.0 * std::numbers::pi);
  const double yaw_radps2 = saturated(
      gains_.yaw.kp * yaw_error_rad - gains_.yaw.kd * rate_radps.z(), gains_.yaw.output_limit);
  // Beyond 60 degrees more thrust only pushes sideways.
  const double lift_share = std::max(0.5, std::cos(tilt(estimate.q_WB)));
  Wrench wrench;
  wrench.thrust_N = std::max(0.0, airframe_.mass_kg * setpoint.thrust_mps2 / lift_share);
  wrench.torque_B_Nm = {airframe_.inertia_roll_kgm2 * roll_radps2,
                        airframe_.inertia_pitch_kgm2 * pitch_radps2,
                        airframe_.inertia_yaw_kgm2 * yaw_radps2};
  return mixer_.commands(wrench);
}

}  // namespace cuscus::flight
