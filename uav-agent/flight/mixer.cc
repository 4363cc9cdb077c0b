#include "uav-agent/flight/mixer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cuscus::flight {
namespace {
// Signs of the motors' thrusts in each torque: front left, front right, rear left, rear right.
constexpr std::array<double, 4> kRoll{1.0, -1.0, 1.0, -1.0};
constexpr std::array<double, 4> kPitch{-1.0, -1.0, 1.0, 1.0};
constexpr std::array<double, 4> kYaw{-1.0, 1.0, 1.0, -1.0};
}  // namespace

Mixer::Mixer(const Airframe& airframe, double command_min)
    : roll_lever_m_{airframe.arm_m * std::numbers::sqrt2 / 2.0},
      yaw_lever_m_{airframe.torque_factor / airframe.thrust_factor},
      thrust_max_N_{airframe.motor_thrust_max_N()},
      thrust_min_N_{airframe.motor_thrust_max_N() * command_min * command_min} {}

MotorCommands Mixer::commands(const Wrench& wanted) const {
  std::array<double, 4> tilt_N{};
  std::array<double, 4> yaw_N{};
  for (std::size_t i = 0; i < 4; ++i) {
    tilt_N[i] = (kRoll[i] * wanted.torque_B_Nm.x() + kPitch[i] * wanted.torque_B_Nm.y()) /
                (4.0 * roll_lever_m_);
    yaw_N[i] = kYaw[i] * wanted.torque_B_Nm.z() / (4.0 * yaw_lever_m_);
  }
  const double range_N = thrust_max_N_ - thrust_min_N_;
  const auto [low, high] = std::minmax_element(tilt_N.begin(), tilt_N.end());
  const double spread_N = *high - *low;
  const double tilt_share = spread_N > range_N ? range_N / spread_N : 1.0;
  const double base_N =
      std::clamp(wanted.thrust_N / 4.0, thrust_min_N_ - tilt_share * *low,
                 std::max(thrust_min_N_ - tilt_share * *low, thrust_max_N_ - tilt_share * *high));
  double yaw_share = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double thrust_N = base_N + tilt_share * tilt_N[i];
    const double room_N = yaw_N[i] > 0.0 ? thrust_max_N_ - thrust_N : thrust_N - thrust_min_N_;
    if (std::abs(yaw_N[i]) > room_N) {
      yaw_share = std::min(yaw_share, std::max(0.0, room_N) / std::abs(yaw_N[i]));
    }
  }
  MotorCommands commands{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double thrust_N = base_N + tilt_share * tilt_N[i] + yaw_share * yaw_N[i];
    commands[i] = std::sqrt(std::clamp(thrust_N, thrust_min_N_, thrust_max_N_) / thrust_max_N_);
  }
  return commands;
}

Wrench Mixer::wrench(const MotorCommands& commands) const {
  Wrench wrench;
  for (std::size_t i = 0; i < 4; ++i) {
    const double thrust_N = thrust_max_N_ * commands[i] * commands[i];
    wrench.thrust_N += thrust_N;
    wrench.torque_B_Nm +=
        thrust_N * Eigen::Vector3d{kRoll[i] * roll_lever_m_, kPitch[i] * roll_lever_m_,
                                   kYaw[i] * yaw_lever_m_};
  }
  return wrench;
}

}  // namespace cuscus::flight
