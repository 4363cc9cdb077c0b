#pragma once

#include <cstdint>
#include <optional>

#include "common/units/sim_time.h"
#include "uav-agent/flight/cascade.h"
#include "uav-agent/flight/trapezoid_profile.h"
#include "uav-agent/missions/circle_law.h"

namespace cuscus::missions {

/// Set-points of one UAV that circles with its fleet: from where the take-off ended straight to the
/// entry point of its slot (angle 2 pi slot / n), where it arrives at rest; then round the circle.
///
/// On the circle the position asked for is the nearest point of it, so that position errors act
/// across the path only; along the path the speed of circle_law() is asked for, with the
/// centripetal acceleration of the present speed fed forward.
class CircleMission {
 public:
  CircleMission(const CircleParameters& circle, std::uint32_t slot, std::uint32_t fleet_size);

  /// What to fly at `now`; called every control period from the moment that the vehicle is at
  /// altitude. `heading_rad` is kept.
  [[nodiscard]] flight::Setpoint setpoint(SimTime now, const flight::VehicleEstimate& estimate,
                                          const NeighbourAngles& neighbours, double heading_rad);

  [[nodiscard]] bool circling() const { return circling_; }
  /// Where this slot joins the circle.
  [[nodiscard]] Eigen::Vector3d entry_point_m() const;

 private:
  [[nodiscard]] flight::Setpoint enter(SimTime now, const flight::VehicleEstimate& estimate);
  [[nodiscard]] flight::Setpoint circle(const flight::VehicleEstimate& estimate,
                                        const NeighbourAngles& neighbours, double dt_s);

  struct Entry {
    flight::TrapezoidProfile profile;
    SimTime began;
    Eigen::Vector3d p_WB_from_m;
    Eigen::Vector3d direction;
  };

  CircleParameters circle_;
  std::uint32_t slot_;
  std::uint32_t fleet_size_;
  std::optional<Entry> entry_;
  bool circling_ = false;
  double ceiling_mps_ = 0.0;  ///< Of the speed along the circle: rises from 0 when it begins.
  std::optional<SimTime> last_;
};

}  // namespace cuscus::missions
