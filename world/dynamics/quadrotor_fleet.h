#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "world/dynamics/plant.h"

namespace cuscus::world {

/// Quadrotors as rigid bodies with linear drag:
///
///   ṗ = v
///   m v̇ = T R e₃ − diag(f_lat, f_lat, f_vert) v − m g e₃
///   q̇ = ½ q ⊗ (0, ω)
///   J ω̇ = τ − ω × Jω
///
/// with p, v in the world (ENU), ω in the body (FLU), R = R(q) from body to world, T and τ of
/// rotor_wrench(), the rest of MultirotorParameters. Solved by the classical fourth-order
/// Runge-Kutta method with constant T and τ during a step; q is normalised after each.
///
/// Source: FL-AIR's X4 (parameters, shape of the drag) with its signs corrected; docs/models/x4.md
/// has the derivation and the list of differences. FlairFleet is the plant with FL-AIR's own signs.
///
/// Ground: z cannot fall below 0. A vehicle that reaches it stops at once, without bouncing, and
/// stands level with its heading kept; from a tilt above 45° it lies as it fell. It rests, whatever
/// its torques, until the vertical part of its thrust exceeds its weight.
///
/// Vehicles are stored as structures of arrays in blocks of eight lanes, and every lane of every
/// block runs the same operations, so that neither the size of the fleet nor a vehicle's place in
/// it changes a bit of its path. 1 kHz is ample: see the convergence test.
class QuadrotorFleet final : public Plant {
 public:
  QuadrotorFleet(std::span<const MultirotorParameters> vehicles, const PlantSettings& settings);

  [[nodiscard]] std::size_t size() const override { return parameters_.size(); }
  void set_state(std::size_t vehicle, const RigidBodyState& state) override;
  void rest(std::size_t vehicle) override;
  [[nodiscard]] RigidBodyState state(std::size_t vehicle) const override;
  void set_commands(std::size_t vehicle, const RotorCommands& commands) override;
  void step() override;
  [[nodiscard]] bool on_ground(std::size_t vehicle) const override;
  [[nodiscard]] Eigen::Vector3d specific_force_mps2(std::size_t vehicle) const override;

 private:
  static constexpr std::size_t kLanes = 8;
  using Lanes = std::array<double, kLanes>;

  /// Eight vehicles. Spare lanes of the last block rest on the ground.
  struct alignas(64) Block {
    Lanes px, py, pz, vx, vy, vz, qw, qx, qy, qz, wx, wy, wz;  // state
    Lanes thrust, torque_x, torque_y, torque_z;                // from the commands
    Lanes mass, drag_lateral, drag_vertical, inertia_x, inertia_y, inertia_z;
    Lanes on_ground;  // 1 or 0
  };

  [[nodiscard]] bool rests(const Block& block, std::size_t lane) const noexcept;
  void integrate(Block& block) const noexcept;
  static void stand(Block& block, std::size_t lane) noexcept;

  PlantSettings settings_;
  std::vector<MultirotorParameters> parameters_;
  std::vector<Block> blocks_;
};

}  // namespace cuscus::world
