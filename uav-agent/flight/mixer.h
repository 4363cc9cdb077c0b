#pragma once

#include <Eigen/Core>

#include "uav-agent/flight/airframe.h"
#include "uav-agent/flight/readings.h"

namespace cuscus::flight {

/// Thrust along body z and torques about the body axes (FLU).
struct Wrench {
  double thrust_N = 0.0;
  Eigen::Vector3d torque_B_Nm = Eigen::Vector3d::Zero();
};

/// Turns a wrench into the commands of an X4's motors, and back.
///
/// With d = arm sqrt(2)/2, kappa = c_mot / k_mot and thrusts f of front left, front right, rear
/// left and rear right, in FLU (z up):
///
///   T     = fl + fr + rl + rr
///   roll  = d (fl + rl - fr - rr)
///   pitch = d (rl + rr - fl - fr)
///   yaw   = -kappa (fl + rr - fr - rl)
///
/// FL-AIR's own formulas are in NED (x forward, y right, z down): u_roll = d (fl + rl - fr - rr),
/// u_pitch = d (fl + fr - rl - rr), u_yaw = c (fl + rr - fr - rl). Roll keeps its sign, pitch and
/// yaw change it with their axes. This is the only place that knows which way a rotor turns.
class Mixer {
 public:
  /// Motors never turn slower than `command_min` while the mixer drives them.
  Mixer(const Airframe& airframe, double command_min);

  /// Commands for `wanted`. What the motors cannot do is given up in this order: yaw first, then
  /// thrust, and roll and pitch last, because the attitude is what keeps a vehicle in the air.
  [[nodiscard]] MotorCommands commands(const Wrench& wanted) const;

  /// What `commands` do.
  [[nodiscard]] Wrench wrench(const MotorCommands& commands) const;

 private:
  double roll_lever_m_;
  double yaw_lever_m_;
  double thrust_max_N_;
  double thrust_min_N_;
};

}  // namespace cuscus::flight
