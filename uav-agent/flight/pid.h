#pragma once

namespace cuscus::flight {

/// `x` limited to [-limit, limit].
[[nodiscard]] double saturated(double x, double limit);

struct PidGains {
  double kp = 0.0;
  double ki = 0.0;
  double kd = 0.0;
  double integral_limit = 0.0;  ///< Of ki times the integral, in units of the output.
  double output_limit = 0.0;
};

/// u = Sat(kp e + Sat(ki ∫e dt) + kd de/dt), the derivative given by the caller: it comes from a
/// measured velocity, not from a difference. FL-AIR's Pid and PidThrust have the same shape.
class Pid {
 public:
  explicit Pid(const PidGains& gains) : gains_{gains} {}

  /// The output for `error` and its `rate` now. The integral stops while it would push a saturated
  /// output further out.
  double step(double error, double rate, double dt_s);

  /// Sets ki times the integral, limited.
  void set_integral(double value) { integral_ = saturated(value, gains_.integral_limit); }
  [[nodiscard]] double integral() const { return integral_; }

 private:
  PidGains gains_;
  double integral_ = 0.0;  ///< ki times the integral of the error.
};

struct NestedSatGains {
  double reference_limit_rad = 0.0;
  double kp_ps = 0.0;  ///< Rate asked for per angle error [1/s].
  double rate_limit_radps = 0.0;
  double kd_ps = 0.0;  ///< Angular acceleration per rate error [1/s].
  double output_limit_radps2 = 0.0;
};

/// u = Sat((Sat((Sat(reference) - angle) kp) - rate) kd): the nested saturations with which FL-AIR
/// holds roll and pitch (reference: FL-AIR's NestedSat; its sign of u is the opposite, since its
/// mixer's is). The inner limits bound the angle asked for and the rate on the way to it, so that a
/// step in position never becomes a somersault. Here u is an angular acceleration [rad/s^2].
[[nodiscard]] double nested_saturation(double reference_rad, double angle_rad, double rate_radps,
                                       const NestedSatGains& gains);

}  // namespace cuscus::flight
