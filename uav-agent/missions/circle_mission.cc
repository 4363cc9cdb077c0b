#include "uav-agent/missions/circle_mission.h"

#include <algorithm>
#include <cmath>

#include "uav-agent/missions/angle.h"

namespace cuscus::missions {
namespace {
/// The entry is over this near to its end.
constexpr double kArrived_m = 0.5;
constexpr double kPeriodMax_s = 0.1;
}  // namespace

CircleMission::CircleMission(const CircleParameters& circle, std::uint32_t slot,
                             std::uint32_t fleet_size)
    : circle_{circle}, slot_{slot}, fleet_size_{fleet_size} {}

Eigen::Vector3d CircleMission::entry_point_m() const {
  const double angle_rad = kTurn_rad * slot_ / fleet_size_;
  return circle_.p_WC_centre_m +
         circle_.radius_m * Eigen::Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0.0};
}

flight::Setpoint CircleMission::setpoint(SimTime now, const flight::VehicleEstimate& estimate,
                                         const NeighbourAngles& neighbours, double heading_rad) {
  const double dt_s = last_ ? std::clamp(to_seconds(now - *last_), 0.0, kPeriodMax_s) : 0.0;
  last_ = now;
  flight::Setpoint setpoint = circling_ ? circle(estimate, neighbours, dt_s) : enter(now, estimate);
  setpoint.yaw_rad = heading_rad;
  return setpoint;
}

flight::Setpoint CircleMission::enter(SimTime now, const flight::VehicleEstimate& estimate) {
  if (!entry_) {
    const Eigen::Vector3d way_m = entry_point_m() - estimate.p_WB_m;
    const double length_m = way_m.norm();
    entry_ = Entry{
        .profile = {0.0, length_m, circle_.entry_speed_mps, circle_.entry_acceleration_mps2},
        .began = now,
        .p_WB_from_m = estimate.p_WB_m,
        .direction = length_m > 0.0 ? Eigen::Vector3d{way_m / length_m} : Eigen::Vector3d::Zero()};
  }
  const double elapsed_s = to_seconds(now - entry_->began);
  const flight::ProfilePoint point = entry_->profile.at(elapsed_s);
  if (elapsed_s >= entry_->profile.duration_s() &&
      (estimate.p_WB_m - entry_point_m()).norm() < kArrived_m) {
    circling_ = true;
  }
  return {.p_WB_m = entry_->p_WB_from_m + point.position_m * entry_->direction,
          .v_WB_mps = point.velocity_mps * entry_->direction,
          .a_WB_mps2 = point.acceleration_mps2 * entry_->direction};
}

flight::Setpoint CircleMission::circle(const flight::VehicleEstimate& estimate,
                                       const NeighbourAngles& neighbours, double dt_s) {
  const double angle_rad = angle_of(estimate.p_WB_m, circle_);
  const Eigen::Vector3d outwards{std::cos(angle_rad), std::sin(angle_rad), 0.0};
  const Eigen::Vector3d along{-std::sin(angle_rad), std::cos(angle_rad), 0.0};
  const double wanted_mps =
      circle_.radius_m * circle_law(angle_rad, fleet_size_, neighbours, circle_);
  // A ceiling that rises, and not a limit of the rate of change: beacons let the wanted speed jump
  // up and sink slowly, and cutting only the jumps off would slow the fleet down.
  const double top_mps = circle_.speed_limit_ratio * circle_.speed_mps;
  ceiling_mps_ = std::min(ceiling_mps_ + circle_.acceleration_mps2 * dt_s, top_mps);
  const double speed_mps = std::min(wanted_mps, ceiling_mps_);
  // The present speed, not the wanted one: it is what bends the path.
  const double present_mps =
      std::clamp(along.dot(estimate.v_WB_mps), 0.0, circle_.speed_limit_ratio * circle_.speed_mps);
  return {.p_WB_m = circle_.p_WC_centre_m + circle_.radius_m * outwards,
          .v_WB_mps = speed_mps * along,
          .a_WB_mps2 = -(present_mps * present_mps / circle_.radius_m) * outwards};
}

}  // namespace cuscus::missions
