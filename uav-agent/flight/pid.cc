#include "uav-agent/flight/pid.h"

#include <algorithm>

namespace cuscus::flight {

double saturated(double x, double limit) { return std::clamp(x, -limit, limit); }

double Pid::step(double error, double rate, double dt_s) {
  const double direct = gains_.kp * error + gains_.kd * rate;
  const double grown = saturated(integral_ + gains_.ki * error * dt_s, gains_.integral_limit);
  const double output = direct + grown;
  const bool outwards = (output > gains_.output_limit && grown > integral_) ||
                        (output < -gains_.output_limit && grown < integral_);
  if (!outwards) {
    integral_ = grown;
  }
  return saturated(direct + integral_, gains_.output_limit);
}

double nested_saturation(double reference_rad, double angle_rad, double rate_radps,
                         const NestedSatGains& gains) {
  const double angle_error_rad = saturated(reference_rad, gains.reference_limit_rad) - angle_rad;
  const double rate_reference_radps =
      saturated(angle_error_rad * gains.kp_ps, gains.rate_limit_radps);
  return saturated((rate_reference_radps - rate_radps) * gains.kd_ps, gains.output_limit_radps2);
}

}  // namespace cuscus::flight
