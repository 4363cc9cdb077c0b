#pragma once

#include <array>
#include <cmath>

#include "common/units/constants.h"
#include "world/dynamics/plant.h"
#include "world/dynamics/quadrotor_fleet.h"

namespace cuscus::world {

inline constexpr double kStep_s = 1e-3;
inline constexpr PlantSettings kEarth{.step_s = kStep_s, .gravity_mps2 = kGravity_mps2};
inline constexpr PlantSettings kSpace{.step_s = kStep_s, .gravity_mps2 = 0.0};

/// A plant with one vehicle.
template <typename Fleet = QuadrotorFleet>
Fleet single(const MultirotorParameters& parameters, const PlantSettings& settings = kEarth) {
  return Fleet{std::array{parameters}, settings};
}

inline RigidBodyState in_the_air(double z_m = 1000.0) { return {.p_WB_m = {0.0, 0.0, z_m}}; }

inline void fly(Plant& plant, double duration_s, double step_s = kStep_s) {
  const auto steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) {
    plant.step();
  }
}

/// The X4 in vacuum.
inline MultirotorParameters without_drag(MultirotorParameters parameters) {
  parameters.drag_lateral_Nspm = 0.0;
  parameters.drag_vertical_Nspm = 0.0;
  return parameters;
}

}  // namespace cuscus::world
