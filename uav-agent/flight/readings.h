#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "common/units/sim_time.h"

namespace cuscus::flight {

/// Gyroscope and accelerometer at one instant. Body frame B: FLU.
struct ImuReading {
  SimTime time;
  std::uint64_t sequence = 0;
  Eigen::Vector3d angular_rate_B_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_mps2 = Eigen::Vector3d::Zero();  ///< +g upwards at rest.
};

/// Where a motion-capture system saw a body. World frame W: ENU; body frame B: FLU.
struct MotionCaptureReading {
  SimTime time;
  std::uint64_t sequence = 0;
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

/// Commands of an X4's motors, 0 ... 1: front left, front right, rear left, rear right.
using MotorCommands = std::array<double, 4>;

}  // namespace cuscus::flight
