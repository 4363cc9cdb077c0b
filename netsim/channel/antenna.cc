#include "netsim/channel/antenna.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace cuscus::netsim {
namespace {

using std::numbers::pi;

void require_antenna(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"antenna: " + rule};
  }
}

}  // namespace

Decibel HalfWaveDipole::gain(const Eigen::Vector3d& direction_B) const {
  constexpr double kDirectivity = 1.64092;
  const Eigen::Vector3d d_B = direction_B.normalized();
  const double sin2 = d_B.x() * d_B.x() + d_B.y() * d_B.y();
  if (sin2 == 0.0) {
    return kFloor;
  }
  const double numerator = std::cos(pi / 2.0 * d_B.z());
  const double ratio = kDirectivity * numerator * numerator / sin2;
  return std::max(Decibel::from_ratio(ratio), kFloor);
}

AntennaPattern::AntennaPattern(std::vector<double> gains_dbi, std::uint32_t azimuths)
    : gains_dbi_{std::move(gains_dbi)},
      azimuths_{azimuths},
      elevations_{azimuths == 0 ? 0 : gains_dbi_.size() / azimuths} {
  require_antenna(elevations_ >= 2 && elevations_ * azimuths_ == gains_dbi_.size(),
                  "a pattern must have at least 2 elevations and a gain for every azimuth of each");
  require_antenna(std::all_of(gains_dbi_.begin(), gains_dbi_.end(),
                              [](double gain_dbi) { return std::isfinite(gain_dbi); }),
                  "the gains of a pattern must be finite");
}

double AntennaPattern::in_row(std::size_t row, double column) const {
  const double whole = std::floor(column);
  const std::size_t left = static_cast<std::size_t>(whole) % azimuths_;
  const double* const gains_dbi = gains_dbi_.data() + row * azimuths_;
  return std::lerp(gains_dbi[left], gains_dbi[(left + 1) % azimuths_], column - whole);
}

Decibel AntennaPattern::gain(const Eigen::Vector3d& direction_B) const {
  const double elevation_rad =
      std::atan2(direction_B.z(), std::hypot(direction_B.x(), direction_B.y()));
  const double azimuth_rad = std::atan2(direction_B.y(), direction_B.x());
  const double turn = azimuth_rad < 0.0 ? azimuth_rad / (2.0 * pi) + 1.0 : azimuth_rad / (2.0 * pi);
  const double column = turn * static_cast<double>(azimuths_);
  const double top = static_cast<double>(elevations_ - 1);
  const double row = std::clamp((elevation_rad / pi + 0.5) * top, 0.0, top);
  const std::size_t below = std::min(static_cast<std::size_t>(row), elevations_ - 2);
  return {std::lerp(in_row(below, column), in_row(below + 1, column),
                    row - static_cast<double>(below))};
}

std::unique_ptr<const Antenna> make_antenna(const AntennaParameters& parameters) {
  if (parameters.model == "isotropic") {
    return nullptr;
  }
  if (parameters.model == "dipole") {
    return std::make_unique<HalfWaveDipole>();
  }
  if (parameters.model == "pattern") {
    return std::make_unique<AntennaPattern>(parameters.pattern_dbi, parameters.pattern_azimuths);
  }
  throw std::invalid_argument{"antenna '" + parameters.model +
                              "' is not known; allowed are 'isotropic', 'dipole', 'pattern'"};
}

EndGains gains_of_ends(const Antenna& antenna, const AntennaPose& a, const AntennaPose& b) {
  const Eigen::Vector3d p_AB_W = b.p_WB - a.p_WB;
  if (p_AB_W.isZero(0.0)) {
    return {};
  }
  return {.at_a = antenna.gain(a.q_WB.conjugate() * p_AB_W),
          .at_b = antenna.gain(b.q_WB.conjugate() * -p_AB_W)};
}

Decibel gain_of_both(const Antenna& antenna, const AntennaPose& a, const AntennaPose& b) {
  const EndGains gains = gains_of_ends(antenna, a, b);
  return gains.at_a + gains.at_b;
}

}  // namespace cuscus::netsim
