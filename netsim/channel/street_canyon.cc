#include "netsim/channel/street_canyon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "common/units/constants.h"

namespace cuscus::netsim {

StreetCanyon::StreetCanyon(std::string_view bound)
    : share_of_upper_{bound == "lower" ? 0.0 : (bound == "middle" ? 0.5 : 1.0)} {
  if (bound != "lower" && bound != "middle" && bound != "upper") {
    throw std::invalid_argument{"propagation model 'p1411': bound '" + std::string{bound} +
                                "' is not known; allowed are 'lower', 'middle', 'upper'"};
  }
}

Decibel StreetCanyon::loss(const LinkGeometry& link) const {
  constexpr double kLowestAntenna_m = 1.0;
  constexpr double kNearest_m = 1e-3;  // the logarithm's sake: far below 0 dB
  const double heights_m2 =
      std::max(link.p_WT.z(), kLowestAntenna_m) * std::max(link.p_WR.z(), kLowestAntenna_m);
  const double wavelength_m = kSpeedOfLight_mps / link.carrier_hz;
  const double at_break_db = std::abs(
      20.0 * std::log10(wavelength_m * wavelength_m / (8.0 * std::numbers::pi * heights_m2)));
  const double break_m = 4.0 * heights_m2 / wavelength_m;
  const double distance_m = std::max((link.p_WR - link.p_WT).norm(), kNearest_m);
  const double decades = std::log10(distance_m / break_m);
  const double lower_db = at_break_db + (decades < 0.0 ? 20.0 : 40.0) * decades;
  const double upper_db = at_break_db + 20.0 + (decades < 0.0 ? 25.0 : 40.0) * decades;
  return {std::max(0.0, lower_db + share_of_upper_ * (upper_db - lower_db))};
}

}  // namespace cuscus::netsim
