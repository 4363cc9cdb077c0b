#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "world/dynamics/plant.h"

namespace cuscus::world {

/// Quadrotors that move as FL-AIR's simulated X4 does, integrator and signs included, for comparing
/// with results that were made with FL-AIR. In its own frames, world z down (NED) and body FRD,
/// with T and (u_roll, u_pitch, u_yaw) the thrust and torques, h the step:
///
///   ω_x += h/J_x ((J_z − J_y) ω_y ω_z + u_roll)     coupling with the wrong sign
///   ω_y += h/J_y ((J_x − J_z) ω_x ω_z + u_pitch)    likewise
///   ω_z += h/J_z u_yaw                              no coupling
///   q += h/2 q ⊗ (0, ω), normalised                 with the new ω
///   F = R(q) (0, 0, −T) + (−f_lat v_x, −f_lat v_y, +f_vert v_z + m g)    vertical drag pushes
///   p[k] = h²/m F + 2 p[k−1] − p[k−2]
///   v[k] = (p[k] − p[k−1]) / h
///
/// Source: FL-AIR, X4.cpp, X4_impl::CalcModel; docs/models/x4.md lists the differences from
/// QuadrotorFleet, and one test shows each.
/// Departs from it in the ground, which FL-AIR leaves to its 3-D engine: like there, a vehicle that
/// would sink below z = 0 is frozen at the place where it was, its last two positions made the
/// same; unlike QuadrotorFleet it may turn while it stands.
/// FL-AIR's x axis points where its yaw option says; here it is east.
class FlairFleet final : public Plant {
 public:
  FlairFleet(std::span<const MultirotorParameters> vehicles, const PlantSettings& settings);

  [[nodiscard]] std::size_t size() const override { return vehicles_.size(); }
  void set_state(std::size_t vehicle, const RigidBodyState& state) override;
  void rest(std::size_t vehicle) override;
  [[nodiscard]] RigidBodyState state(std::size_t vehicle) const override;
  void set_commands(std::size_t vehicle, const RotorCommands& commands) override;
  void step() override;
  [[nodiscard]] bool on_ground(std::size_t vehicle) const override;
  [[nodiscard]] Eigen::Vector3d specific_force_mps2(std::size_t vehicle) const override;

 private:
  /// All vectors in FL-AIR's frames.
  struct Vehicle {
    MultirotorParameters parameters;
    double thrust_N;
    Eigen::Vector3d torque_Nm;
    Eigen::Vector3d position_m;
    Eigen::Vector3d previous_position_m;
    Eigen::Vector3d velocity_mps;
    Eigen::Quaterniond attitude;
    Eigen::Vector3d rates_radps;
    bool on_ground;
  };

  void step(Vehicle& vehicle) const;

  PlantSettings settings_;
  std::vector<Vehicle> vehicles_;
};

}  // namespace cuscus::world
