#pragma once

namespace cuscus::flight {

/// A point of a trajectory along one line.
struct ProfilePoint {
  double position_m = 0.0;
  double velocity_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// A move from one point to another that starts and ends at rest: constant acceleration, constant
/// speed, constant deceleration; without the middle when the way is short. FL-AIR's
/// TrajectoryGenerator1D has the same shape.
class TrapezoidProfile {
 public:
  /// `speed_mps` and `acceleration_mps2` are limits and positive.
  TrapezoidProfile(double from_m, double to_m, double speed_mps, double acceleration_mps2);

  /// `elapsed_s` after the start; before it the start, after the end the end.
  [[nodiscard]] ProfilePoint at(double elapsed_s) const;
  [[nodiscard]] double duration_s() const { return 2.0 * ramp_s_ + cruise_s_; }

 private:
  double from_m_;
  double to_m_;
  double direction_;
  double acceleration_mps2_;
  double ramp_s_;
  double cruise_s_;
};

}  // namespace cuscus::flight
