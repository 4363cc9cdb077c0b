#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <cstddef>

#include "common/city/city.h"
#include "common/units/sim_time.h"

namespace cuscus::world {

inline constexpr std::size_t kSatellites = 24;

/// The sky over a site: the 24 slots of the GPS on circular orbits, seen from there.
///
/// Slot i of right ascension Ω and argument of latitude u0 at the reference t0 is, in
/// earth-centred, earth-fixed axes, at
///
///   a (cos u cos L - sin u cos i sin L, cos u sin L + sin u cos i cos L, sin u sin i),
///   u = u0 + 2 ω (t - t0),  L = Ω - θ0 - ω (t - t0),
///
/// with the inclination i = 55 degrees, the Earth's rate ω (WGS-84), the Greenwich angle θ0 of t0,
/// and the radius a = (GM / (2 ω)²)^(1/3) = 26 562 km of half a sidereal day. So the sky is the
/// same again after each sidereal day.
///
/// Source: GPS Standard Positioning Service Performance Standard, October 2001, table 3-1 (slots,
/// t0, θ0, i) and its 26 559.7 km, whose nodes drift westwards. Here they do not: which satellites
/// are up at an epoch is typical, and not what was up on that day. No eccentricity, no leap
/// seconds.
class Constellation {
 public:
  /// Over `site`, in a run that begins at `epoch` (UTC).
  Constellation(const city::Geodetic& site, std::chrono::sys_seconds epoch);

  /// Where every satellite is at `time` of the run: from the site, of length 1; east, north, up of
  /// the ellipsoid. Below the horizon too.
  [[nodiscard]] std::array<Eigen::Vector3d, kSatellites> directions(SimTime time) const;

 private:
  Eigen::Vector3d p_ES_m_;  // the site, in earth-fixed axes
  Eigen::Matrix3d R_WE_;
  double since_reference_s_;  // of the run's begin
};

}  // namespace cuscus::world
