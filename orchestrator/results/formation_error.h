#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cuscus::orchestrator {

/// The circle that a fleet flies on: level, at the height of its centre. World frame W: ENU.
struct FormationCircle {
  Eigen::Vector3d p_WC_m;  ///< Centre.
  double radius_m;         ///< Above 0.
};

/// Where one UAV of the fleet truly is.
struct FormationMember {
  Eigen::Vector3d p_WB_m;
  std::uint32_t slot;  ///< Its place in the formation: 0 ... n - 1, one UAV in each.
};

struct FormationError {
  double phase_rad;             ///< Common phase φ of the reference positions, in (−π, π].
  std::vector<double> error_m;  ///< Distance of each member from its reference, in their order.
  double mean_m;
  double rms_m;
  double max_m;
};

/// How far a fleet is from n equally spaced points on a circle, wherever on the circle they are:
///
///   φ = arg Σ_i exp(j (θ_i − 2π s_i / n)),   r_i = C + R (cos(φ + 2π s_i / n), sin(φ + 2π s_i /
///   n), 0) error_i = |p_i − r_i|
///
/// with θ_i the azimuth of member i seen from the centre C, counter-clockwise from east, s_i its
/// slot and R the radius. φ is the circular mean (K. V. Mardia, P. E. Jupp, "Directional
/// Statistics", Wiley 2000, section 2.2.1) of the phases at which the members would have the ring.
/// A member exactly above, below or at the centre has no azimuth and no say in φ. When the phases
/// cancel out, φ is 0: then no phase suits the fleet better than another.
///
/// @throws std::invalid_argument when the slots are not 0 ... n - 1, each once, or the radius is
/// not above 0, or there is no member.
[[nodiscard]] FormationError formation_error(const FormationCircle& circle,
                                             std::span<const FormationMember> members);

}  // namespace cuscus::orchestrator
