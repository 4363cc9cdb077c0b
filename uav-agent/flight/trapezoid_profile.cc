#include "uav-agent/flight/trapezoid_profile.h"

#include <algorithm>
#include <cmath>

namespace cuscus::flight {

TrapezoidProfile::TrapezoidProfile(double from_m, double to_m, double speed_mps,
                                   double acceleration_mps2)
    : from_m_{from_m},
      to_m_{to_m},
      direction_{to_m < from_m ? -1.0 : 1.0},
      acceleration_mps2_{acceleration_mps2} {
  const double way_m = std::abs(to_m - from_m);
  const double top_mps = std::min(speed_mps, std::sqrt(way_m * acceleration_mps2));
  ramp_s_ = top_mps / acceleration_mps2;
  cruise_s_ = top_mps > 0.0 ? std::max(0.0, way_m / top_mps - ramp_s_) : 0.0;
}

ProfilePoint TrapezoidProfile::at(double elapsed_s) const {
  if (elapsed_s <= 0.0) {
    return {.position_m = from_m_};
  }
  if (elapsed_s >= duration_s()) {
    return {.position_m = to_m_};
  }
  const double a = acceleration_mps2_;
  const double top_mps = a * ramp_s_;
  if (elapsed_s < ramp_s_) {
    return {.position_m = from_m_ + direction_ * 0.5 * a * elapsed_s * elapsed_s,
            .velocity_mps = direction_ * a * elapsed_s,
            .acceleration_mps2 = direction_ * a};
  }
  if (elapsed_s < ramp_s_ + cruise_s_) {
    return {.position_m = from_m_ + direction_ * top_mps * (elapsed_s - 0.5 * ramp_s_),
            .velocity_mps = direction_ * top_mps,
            .acceleration_mps2 = 0.0};
  }
  const double left_s = duration_s() - elapsed_s;
  return {.position_m = to_m_ - direction_ * 0.5 * a * left_s * left_s,
          .velocity_mps = direction_ * a * left_s,
          .acceleration_mps2 = -direction_ * a};
}

}  // namespace cuscus::flight
