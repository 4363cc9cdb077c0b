#pragma once

#include "common/units/constants.h"

namespace cuscus::flight {

/// What the control laws believe of their vehicle: nominal values, which may differ from the plant.
/// A motor at command u turns at motor_speed_per_command * u (in "speed units") and gives
/// thrust_factor * speed^2 newton. Defaults: FL-AIR's X4 (simulator_x4.xml; SimuBldc k 86).
struct Airframe {
  double mass_kg = 1.2;
  double arm_m = 0.2;            ///< Centre to rotor; rotors at 45 degrees to the axes.
  double thrust_factor = 0.001;  ///< k_mot [N per speed unit^2].
  double torque_factor = 0.001;  ///< c_mot [N m per speed unit^2].
  double drag_lateral = 0.4;     ///< [N per m/s].
  double inertia_roll_kgm2 = 0.006;
  double inertia_pitch_kgm2 = 0.006;
  double inertia_yaw_kgm2 = 0.1;
  double motor_speed_per_command = 86.0;
  double gravity_mps2 = kGravity_mps2;

  /// Thrust of one motor at command 1 [N].
  [[nodiscard]] double motor_thrust_max_N() const {
    return thrust_factor * motor_speed_per_command * motor_speed_per_command;
  }
};

}  // namespace cuscus::flight
