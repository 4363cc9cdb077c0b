#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#include "world/dynamics/rotor_wrench.h"

namespace cuscus::world {

/// Where a rigid body is. World frame W: ENU, z = 0 on the ground; body frame B: FLU.
struct RigidBodyState {
  Eigen::Vector3d p_WB_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d v_WB_W_mps{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond q_WB{Eigen::Quaterniond::Identity()};  ///< Unit.
  Eigen::Vector3d w_WB_B_radps{Eigen::Vector3d::Zero()};
};

/// What all vehicles of a plant share.
struct PlantSettings {
  double step_s;
  double gravity_mps2;
  /// Whether the plane z = 0 is the ground. Otherwise nothing carries a vehicle but rest().
  bool ground{true};
};

/// Vehicles that fly by their rotor commands, in steps of one fixed length. Vehicles do not touch
/// one another, so each moves as it would alone, bit for bit.
///
/// All begin at the origin, on the ground, rotors stopped. `vehicle` is below size() throughout.
class Plant {
 public:
  virtual ~Plant() = default;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// Puts a vehicle somewhere; at z = 0 without speed it stands on the ground, if that is there.
  virtual void set_state(std::size_t vehicle, const RigidBodyState& state) = 0;
  /// Something carries the vehicle from now on, where it is: it stops, as on the ground, and stands
  /// until it takes off.
  virtual void rest(std::size_t vehicle) = 0;
  [[nodiscard]] virtual RigidBodyState state(std::size_t vehicle) const = 0;

  /// Holds until the next call. The commands must be finite: a plant trusts its caller.
  virtual void set_commands(std::size_t vehicle, const RotorCommands& commands) = 0;

  /// Advances every vehicle by one step.
  virtual void step() = 0;

  /// Whether the ground carries the vehicle.
  [[nodiscard]] virtual bool on_ground(std::size_t vehicle) const = 0;

  /// All forces but gravity, per mass, in the body frame: what an accelerometer feels [m/s²].
  [[nodiscard]] virtual Eigen::Vector3d specific_force_mps2(std::size_t vehicle) const = 0;
};

}  // namespace cuscus::world
