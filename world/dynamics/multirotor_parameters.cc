#include "world/dynamics/multirotor_parameters.h"

#include <cmath>
#include <stdexcept>

namespace cuscus::world {
namespace {

void require(bool holds, const char* name, double value, const char* allowed) {
  if (!holds) {
    throw std::invalid_argument{std::string{name} + " is " + std::to_string(value) + ", must be " +
                                allowed};
  }
}

void require_positive(const char* name, double value) {
  require(std::isfinite(value) && value > 0.0, name, value, "above 0");
}

void require_not_negative(const char* name, double value) {
  require(std::isfinite(value) && value >= 0.0, name, value, "0 or more");
}

}  // namespace

MultirotorParameters flair_x4(double mass_kg) {
  return {.source = "FL-AIR simulator_x4.xml",
          .mass_kg = mass_kg,
          .arm_m = 0.2,
          .thrust_factor = 0.001,
          .torque_factor = 0.001,
          .drag_vertical_Nspm = 0.01,
          .drag_lateral_Nspm = 0.4,
          .inertia_roll_kgm2 = 0.006,
          .inertia_pitch_kgm2 = 0.006,
          .inertia_yaw_kgm2 = 0.1,
          .motor_speed_per_command = 86.0};
}

void check_parameters(const MultirotorParameters& parameters) {
  require_positive("mass_kg", parameters.mass_kg);
  require_positive("arm_m", parameters.arm_m);
  require_positive("thrust_factor", parameters.thrust_factor);
  require_not_negative("torque_factor", parameters.torque_factor);
  require_not_negative("drag_vertical", parameters.drag_vertical_Nspm);
  require_not_negative("drag_lateral", parameters.drag_lateral_Nspm);
  require_positive("inertia_roll_kgm2", parameters.inertia_roll_kgm2);
  require_positive("inertia_pitch_kgm2", parameters.inertia_pitch_kgm2);
  require_positive("inertia_yaw_kgm2", parameters.inertia_yaw_kgm2);
  require_positive("motor_speed_per_command", parameters.motor_speed_per_command);
}

double hover_command(const MultirotorParameters& parameters, double gravity_mps2) {
  const double thrust_per_rotor_N = parameters.mass_kg * gravity_mps2 / 4.0;
  return std::sqrt(thrust_per_rotor_N / parameters.thrust_factor) /
         parameters.motor_speed_per_command;
}

}  // namespace cuscus::world
