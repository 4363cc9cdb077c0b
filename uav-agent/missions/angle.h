#pragma once

#include <cmath>
#include <numbers>

namespace cuscus::missions {

inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// `angle_rad` brought into [-pi, pi].
[[nodiscard]] inline double wrapped(double angle_rad) {
  return std::remainder(angle_rad, kTurn_rad);
}

}  // namespace cuscus::missions
