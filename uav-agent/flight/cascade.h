#pragma once

#include <Eigen/Core>
#include <numbers>

#include "common/units/autopilot_limits.h"
#include "uav-agent/flight/airframe.h"
#include "uav-agent/flight/estimator.h"
#include "uav-agent/flight/mixer.h"
#include "uav-agent/flight/pid.h"

namespace cuscus::flight {

/// Where the vehicle should be, and how it should move there. World frame W: ENU.
struct Setpoint {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_WB_mps2 = Eigen::Vector3d::Zero();  ///< Fed forward.
  double yaw_rad = 0.0;

  [[nodiscard]] bool is_finite() const;
};

/// Attitude and vertical acceleration asked for: what remains of a set-point when the position is
/// not controlled (take-off ramp, failsafe).
struct AttitudeSetpoint {
  double roll_rad = 0.0;   ///< FLU, Z-Y-X Euler angles: positive roll lowers the right side.
  double pitch_rad = 0.0;  ///< Positive pitch lowers the nose.
  double yaw_rad = 0.0;
  double thrust_mps2 = 0.0;  ///< Thrust per mass, along the world's vertical.
};

/// Gains of the cascade in SI units. docs/models/flight-control.md derives each from FL-AIR's.
struct CascadeGains {
  // FL-AIR: kp 0.2 rad/m, kd 0.2 rad/(m/s), ki 0, applied to the small-angle tilt a/g.
  double horizontal_kp_radpm = 0.2;
  double horizontal_kd_rads_pm = 0.2;
  double tilt_limit_rad = kTiltReferenceLimit_rad;
  PidGains vertical{.kp = 9.0, .ki = 0.6, .kd = 6.0, .integral_limit = 8.0, .output_limit = 12.0};
  NestedSatGains tilt{.reference_limit_rad = kTiltReferenceLimit_rad,
                      .kp_ps = 6.0,
                      .rate_limit_radps = 100.0 * std::numbers::pi / 180.0,
                      .kd_ps = 30.0,
                      .output_limit_radps2 = 100.0};
  PidGains yaw{.kp = 9.0, .ki = 0.0, .kd = 6.0, .integral_limit = 0.0, .output_limit = 5.0};
  double command_min = 0.1;  ///< FL-AIR's Bldc minimum is 0.4; its motor test runs at 0.1.
};

/// Position -> acceleration -> tilt and thrust -> torques -> motors.
class Cascade {
 public:
  Cascade(const Airframe& airframe, const CascadeGains& gains);

  [[nodiscard]] MotorCommands step(const VehicleEstimate& estimate, const Setpoint& setpoint,
                                   double dt_s);
  [[nodiscard]] MotorCommands step(const VehicleEstimate& estimate,
                                   const AttitudeSetpoint& setpoint) const;

  /// What hovering needs beyond the nominal weight [m/s^2 of the nominal mass]: the altitude loop's
  /// integral.
  [[nodiscard]] double hover_offset_mps2() const { return vertical_.integral(); }
  void set_hover_offset(double offset_mps2) { vertical_.set_integral(offset_mps2); }

 private:
  Airframe airframe_;
  CascadeGains gains_;
  Mixer mixer_;
  Pid vertical_;
};

/// Z-Y-X Euler angles (roll, pitch, yaw) of a body's attitude [rad].
[[nodiscard]] Eigen::Vector3d euler_angles(const Eigen::Quaterniond& q_WB);

/// Angle between the body's z axis and the vertical [rad].
[[nodiscard]] double tilt(const Eigen::Quaterniond& q_WB);

}  // namespace cuscus::flight
