#include "world/dynamics/rotor_wrench.h"

#include <numbers>

namespace cuscus::world {

RotorWrench rotor_wrench(const MultirotorParameters& parameters, const RotorCommands& commands) {
  RotorCommands squared_speeds{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    const double speed = parameters.motor_speed_per_command * commands[i];
    squared_speeds[i] = speed * speed;
  }
  const auto [front_left, front_right, rear_left, rear_right] = squared_speeds;
  const double lever = parameters.arm_m / std::numbers::sqrt2 * parameters.thrust_factor;
  return {.thrust_N =
              parameters.thrust_factor * ((front_left + rear_right) + (front_right + rear_left)),
          .torque_x_Nm = lever * ((front_left + rear_left) - (front_right + rear_right)),
          .torque_y_Nm = lever * ((rear_left + rear_right) - (front_left + front_right)),
          .torque_z_Nm =
              parameters.torque_factor * ((front_right + rear_left) - (front_left + rear_right))};
}

}  // namespace cuscus::world
