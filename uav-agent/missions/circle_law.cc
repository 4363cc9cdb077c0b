#include "uav-agent/missions/circle_law.h"

#include <algorithm>
#include <cmath>

#include "uav-agent/missions/angle.h"

namespace cuscus::missions {

double angle_of(const Eigen::Vector3d& p_WB_m, const CircleParameters& circle) {
  return std::atan2(p_WB_m.y() - circle.p_WC_centre_m.y(), p_WB_m.x() - circle.p_WC_centre_m.x());
}

NeighbourAngles neighbour_angles(const NeighbourTable& table, SimTime now,
                                 const CircleParameters& circle) {
  const auto angle = [&](std::uint32_t slot) -> std::optional<double> {
    const auto heard = table.heard(slot, now);
    if (!heard) {
      return std::nullopt;
    }
    const Eigen::Vector3d offset_m = heard->p_WB_m - circle.p_WC_centre_m;
    const double radial_m = std::abs(offset_m.head<2>().norm() - circle.radius_m);
    if (radial_m > circle.ring_tolerance_m ||
        std::abs(offset_m.z()) > circle.altitude_tolerance_m()) {
      return std::nullopt;
    }
    const double age_s = circle.extrapolate ? to_seconds(now - heard->time) : 0.0;
    return angle_of(heard->p_WB_m, circle) + circle.nominal_radps() * age_s;
  };
  const std::uint32_t n = table.fleet_size();
  const std::uint32_t own = table.own_slot();
  return {.previous_rad = angle((own + n - 1) % n), .next_rad = angle((own + 1) % n)};
}

double spacing_error(double own_rad, std::uint32_t fleet_size, const NeighbourAngles& neighbours) {
  const double gap_rad = kTurn_rad / static_cast<double>(fleet_size);
  double sum_rad = 0.0;
  int heard = 0;
  if (neighbours.previous_rad) {
    sum_rad += wrapped(*neighbours.previous_rad + gap_rad - own_rad);
    ++heard;
  }
  if (neighbours.next_rad) {
    sum_rad += wrapped(*neighbours.next_rad - gap_rad - own_rad);
    ++heard;
  }
  return heard == 0 ? 0.0 : sum_rad / heard;
}

double circle_law(double own_rad, std::uint32_t fleet_size, const NeighbourAngles& neighbours,
                  const CircleParameters& circle) {
  const double nominal_radps = circle.nominal_radps();
  const double wanted_radps =
      nominal_radps + circle.spacing_gain_ps * spacing_error(own_rad, fleet_size, neighbours);
  return std::clamp(wanted_radps, 0.0, circle.speed_limit_ratio * nominal_radps);
}

}  // namespace cuscus::missions
