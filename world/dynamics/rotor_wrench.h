#pragma once

#include <array>
#include <cstddef>

#include "world/dynamics/multirotor_parameters.h"

namespace cuscus::world {

inline constexpr std::size_t kRotors = 4;

/// One command per rotor, 0 ... 1: front left, front right, rear left, rear right.
using RotorCommands = std::array<double, kRotors>;

/// What the rotors do to the body, in the body frame B (FLU).
struct RotorWrench {
  double thrust_N;     ///< Along body z, upwards.
  double torque_x_Nm;  ///< Roll: left side up.
  double torque_y_Nm;  ///< Pitch: nose down.
  double torque_z_Nm;  ///< Yaw: nose to the left.
};

/// Forces and torques of four rotors in X configuration:
///
///   f_i = k Ω_i²,  Ω_i = (speed per command) u_i
///   thrust = Σ f_i
///   τ_x = (a/√2) (f_fl + f_rl − f_fr − f_rr)
///   τ_y = (a/√2) (f_rl + f_rr − f_fl − f_fr)
///   τ_z = c (Ω_fr² + Ω_rl² − Ω_fl² − Ω_rr²)
///
/// with k, c, a of MultirotorParameters. The front-left and rear-right rotors turn
/// counter-clockwise seen from above, so that their reaction turns the body clockwise.
///
/// Source: FL-AIR, X4.cpp, with pitch and yaw turned from its FRD body frame to FLU. Like FL-AIR it
/// has no rotor inertia: a command is a speed at once.
[[nodiscard]] RotorWrench rotor_wrench(const MultirotorParameters& parameters,
                                       const RotorCommands& commands);

}  // namespace cuscus::world
