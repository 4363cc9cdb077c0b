#include "world/dynamics/flair_fleet.h"

namespace cuscus::world {
namespace {

// East-south-down from ENU and FRD from FLU, and back: a half turn about x.
Eigen::Vector3d turned_over(const Eigen::Vector3d& vector) {
  return {vector.x(), -vector.y(), -vector.z()};
}

Eigen::Quaterniond turned_over(const Eigen::Quaterniond& rotation) {
  return {rotation.w(), rotation.x(), -rotation.y(), -rotation.z()};
}

/// Aerodynamic force as FL-AIR has it: sideways it brakes, along z it pushes.
Eigen::Vector3d air_force(const MultirotorParameters& parameters,
                          const Eigen::Vector3d& velocity_mps) {
  return {-parameters.drag_lateral_Nspm * velocity_mps.x(),
          -parameters.drag_lateral_Nspm * velocity_mps.y(),
          +parameters.drag_vertical_Nspm * velocity_mps.z()};
}

}  // namespace

FlairFleet::FlairFleet(std::span<const MultirotorParameters> vehicles,
                       const PlantSettings& settings)
    : settings_{settings} {
  vehicles_.reserve(vehicles.size());
  for (const MultirotorParameters& parameters : vehicles) {
    check_parameters(parameters);
    vehicles_.push_back({.parameters = parameters,
                         .thrust_N = 0.0,
                         .torque_Nm = Eigen::Vector3d::Zero(),
                         .position_m = Eigen::Vector3d::Zero(),
                         .previous_position_m = Eigen::Vector3d::Zero(),
                         .velocity_mps = Eigen::Vector3d::Zero(),
                         .attitude = Eigen::Quaterniond::Identity(),
                         .rates_radps = Eigen::Vector3d::Zero(),
                         .on_ground = true});
  }
}

void FlairFleet::set_state(std::size_t vehicle, const RigidBodyState& state) {
  Vehicle& v = vehicles_[vehicle];
  v.position_m = turned_over(state.p_WB_m);
  v.velocity_mps = turned_over(state.v_WB_W_mps);
  v.previous_position_m = v.position_m - settings_.step_s * v.velocity_mps;
  v.attitude = turned_over(state.q_WB);
  v.rates_radps = turned_over(state.w_WB_B_radps);
  v.on_ground = settings_.ground && state.p_WB_m.z() <= 0.0 && v.velocity_mps.isZero(0.0);
}

void FlairFleet::rest(std::size_t vehicle) {
  Vehicle& v = vehicles_[vehicle];
  v.velocity_mps.setZero();
  v.previous_position_m = v.position_m;
  v.on_ground = true;
}

RigidBodyState FlairFleet::state(std::size_t vehicle) const {
  const Vehicle& v = vehicles_[vehicle];
  return {.p_WB_m = turned_over(v.position_m),
          .v_WB_W_mps = turned_over(v.velocity_mps),
          .q_WB = turned_over(v.attitude),
          .w_WB_B_radps = turned_over(v.rates_radps)};
}

void FlairFleet::set_commands(std::size_t vehicle, const RotorCommands& commands) {
  Vehicle& v = vehicles_[vehicle];
  const RotorWrench wrench = rotor_wrench(v.parameters, commands);
  v.thrust_N = wrench.thrust_N;
  v.torque_Nm =
      turned_over(Eigen::Vector3d{wrench.torque_x_Nm, wrench.torque_y_Nm, wrench.torque_z_Nm});
}

void FlairFleet::step() {
  for (Vehicle& vehicle : vehicles_) {
    step(vehicle);
  }
}

void FlairFleet::step(Vehicle& v) const {
  const MultirotorParameters& p = v.parameters;
  const double h = settings_.step_s;

  const Eigen::Vector3d w = v.rates_radps;
  v.rates_radps += Eigen::Vector3d{
      h / p.inertia_roll_kgm2 *
          ((p.inertia_yaw_kgm2 - p.inertia_pitch_kgm2) * w.y() * w.z() + v.torque_Nm.x()),
      h / p.inertia_pitch_kgm2 *
          ((p.inertia_roll_kgm2 - p.inertia_yaw_kgm2) * w.x() * w.z() + v.torque_Nm.y()),
      h / p.inertia_yaw_kgm2 * v.torque_Nm.z()};

  const Eigen::Quaterniond rate{0.0, v.rates_radps.x(), v.rates_radps.y(), v.rates_radps.z()};
  v.attitude.coeffs() += 0.5 * h * (v.attitude * rate).coeffs();
  v.attitude.normalize();

  const Eigen::Vector3d force_N = v.attitude * Eigen::Vector3d{0.0, 0.0, -v.thrust_N} +
                                  air_force(p, v.velocity_mps) +
                                  Eigen::Vector3d{0.0, 0.0, p.mass_kg * settings_.gravity_mps2};
  Eigen::Vector3d next = h * h / p.mass_kg * force_N + 2.0 * v.position_m - v.previous_position_m;
  v.on_ground = settings_.ground ? next.z() >= 0.0 : v.on_ground && next.z() >= v.position_m.z();
  if (v.on_ground) {
    next = {v.position_m.x(), v.position_m.y(), settings_.ground ? 0.0 : v.position_m.z()};
    v.velocity_mps.setZero();
    v.previous_position_m = next;
  } else {
    v.velocity_mps = (next - v.position_m) / h;
    v.previous_position_m = v.position_m;
  }
  v.position_m = next;
}

bool FlairFleet::on_ground(std::size_t vehicle) const { return vehicles_[vehicle].on_ground; }

Eigen::Vector3d FlairFleet::specific_force_mps2(std::size_t vehicle) const {
  const Vehicle& v = vehicles_[vehicle];
  if (v.on_ground) {
    return turned_over(v.attitude.conjugate() * Eigen::Vector3d{0.0, 0.0, -settings_.gravity_mps2});
  }
  const Eigen::Vector3d thrust_N{0.0, 0.0, -v.thrust_N};
  return turned_over((thrust_N + v.attitude.conjugate() * air_force(v.parameters, v.velocity_mps)) /
                     v.parameters.mass_kg);
}

}  // namespace cuscus::world
