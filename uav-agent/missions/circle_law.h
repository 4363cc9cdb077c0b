#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>

#include "uav-agent/missions/neighbour_table.h"

namespace cuscus::missions {

struct CircleParameters {
  Eigen::Vector3d p_WC_centre_m = Eigen::Vector3d::Zero();  ///< z is the altitude of flight.
  double radius_m = 20.0;
  double speed_mps = 2.5;          ///< Along the circle when the spacing is right.
  double spacing_gain_ps = 0.5;    ///< Angular speed per angle of spacing error [1/s].
  double speed_limit_ratio = 2.0;  ///< Speed stays within 0 ... this times speed_mps.
  double acceleration_mps2 = 1.0;  ///< From rest to the speed of the law, on entering the circle.
  double entry_speed_mps = 3.0;    ///< On the straight way from take-off to the circle.
  double entry_acceleration_mps2 = 1.0;
  /// A neighbour this far from the circle in radius, or altitude_tolerance_m() in altitude, does
  /// not fly the formation (on the ground, on its way, in failsafe) and is not kept distance to.
  double ring_tolerance_m = 5.0;
  /// Turn a neighbour's last position on at nominal angular speed for its age. Off: the paper's
  /// agents use positions as last heard, which is what makes the beacon period matter.
  bool extrapolate = false;

  /// speed / radius, counter-clockwise seen from above [rad/s].
  [[nodiscard]] double nominal_radps() const { return speed_mps / radius_m; }

  /// Half the altitude for low circles, so that what lies on the ground is outside of it.
  [[nodiscard]] double altitude_tolerance_m() const {
    return std::min(ring_tolerance_m, 0.5 * p_WC_centre_m.z());
  }
};

/// Angle of a position about the circle's centre, from east, counter-clockwise [rad].
[[nodiscard]] double angle_of(const Eigen::Vector3d& p_WB_m, const CircleParameters& circle);

/// Angles that slots `slot` - 1 and `slot` + 1 are believed to have; nothing when not heard.
struct NeighbourAngles {
  std::optional<double> previous_rad;
  std::optional<double> next_rad;
};

/// Picks the ring neighbours of the table's owner as the law sees them at `now`.
[[nodiscard]] NeighbourAngles neighbour_angles(const NeighbourTable& table, SimTime now,
                                               const CircleParameters& circle);

/// Spacing error e of slot i on a ring of n with even gaps D = 2 pi / n [rad]:
///
///   e = mean over heard neighbours of { wrap(previous + D - own), wrap(next - D - own) }
///
/// With both heard this is the middle of their angles minus one's own; with one, its angle shifted
/// by a gap; with none, 0.
[[nodiscard]] double spacing_error(double own_rad, std::uint32_t fleet_size,
                                   const NeighbourAngles& neighbours);

/// Angular speed of the circle law [rad/s]:
///
///   w = clamp(speed / radius + spacing_gain e, 0, speed_limit_ratio speed / radius)
///
/// Linearised about even spacing, mode m of the ring decays at spacing_gain (1 - cos(2 pi m / n)).
/// The paper (section 5.1) says what the agents do, not by which law: docs/models/circle.md.
[[nodiscard]] double circle_law(double own_rad, std::uint32_t fleet_size,
                                const NeighbourAngles& neighbours, const CircleParameters& circle);

}  // namespace cuscus::missions
