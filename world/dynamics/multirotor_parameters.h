#pragma once

#include <string>

namespace cuscus::world {

/// What a quadrotor is made of. Speeds of rotors are in an arbitrary unit: only their products with
/// the factors are physical.
struct MultirotorParameters {
  std::string source;              ///< Where the numbers come from.
  double mass_kg;                  ///< m
  double arm_m;                    ///< a: from the centre of mass to each rotor.
  double thrust_factor;            ///< k: thrust per squared rotor speed [N].
  double torque_factor;            ///< c: reaction torque per squared rotor speed [N m].
  double drag_vertical_Nspm;       ///< f_vert: force per speed along world z [N s/m].
  double drag_lateral_Nspm;        ///< f_lat: force per speed along world x and y [N s/m].
  double inertia_roll_kgm2;        ///< J_x
  double inertia_pitch_kgm2;       ///< J_y
  double inertia_yaw_kgm2;         ///< J_z
  double motor_speed_per_command;  ///< Rotor speed at command 1.
};

/// FL-AIR's simulated X4 with another mass; the paper's sweep is 1, 1.5 and 2 kg.
///
/// Source: FL-AIR, simulator_x4.xml and setup_x4.xml (resources/core2-64), the values of which
/// AngeloTrotta85/dronet, src/inet/mobility/drone/X4Sim.ned repeats: mass 1.2 kg, arm 0.2 m, k_mot
/// and c_mot 0.001, f_air_vert 0.01, f_air_lat 0.4, j_roll and j_pitch 0.006, j_yaw 0.1; SimuBldc
/// driver gain 86.
[[nodiscard]] MultirotorParameters flair_x4(double mass_kg = 1.2);

/// @throws std::invalid_argument naming the first value that no vehicle can have.
void check_parameters(const MultirotorParameters& parameters);

/// The command at which four rotors carry the weight: sqrt(m g / 4k) / (speed per command).
[[nodiscard]] double hover_command(const MultirotorParameters& parameters, double gravity_mps2);

}  // namespace cuscus::world
