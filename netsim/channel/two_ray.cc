#include "netsim/channel/two_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "common/units/constants.h"

namespace cuscus::netsim {

/// Relative permittivity a f^b and conductivity c f^d [S/m], f in GHz.
struct TwoRay::Ground {
  std::string_view name;
  double a, b, c, d;

  static const std::array<Ground, 3>& all() {
    static constexpr std::array<Ground, 3> kGrounds{{{"very-dry", 3.0, 0.0, 0.00015, 2.52},
                                                     {"medium-dry", 15.0, -0.1, 0.035, 1.63},
                                                     {"wet", 30.0, -0.4, 0.15, 1.30}}};
    return kGrounds;
  }
  static const Ground& named(std::string_view name) {
    std::string allowed;
    for (const Ground& ground : all()) {
      if (ground.name == name) {
        return ground;
      }
      allowed += (allowed.empty() ? "'" : ", '") + std::string{ground.name} + "'";
    }
    throw std::invalid_argument{"propagation model 'two-ray': ground '" + std::string{name} +
                                "' is not known; allowed are " + allowed};
  }
};

TwoRay::TwoRay(const Parameters& parameters)
    : ground_{&Ground::named(parameters.ground)},
      polarisation_{parameters.polarisation},
      roughness_m_{parameters.roughness_m} {
  if (!(roughness_m_ >= 0.0) || !std::isfinite(roughness_m_)) {
    throw std::invalid_argument{"propagation model 'two-ray': roughness must be at least 0 m"};
  }
}

std::vector<std::string> TwoRay::ground_names() {
  std::vector<std::string> names;
  for (const Ground& ground : Ground::all()) {
    names.emplace_back(ground.name);
  }
  return names;
}

Decibel TwoRay::loss(const LinkGeometry& link) const {
  using Complex = std::complex<double>;
  constexpr double kLowest_m = 0.1;
  constexpr double kNearest_m = 1e-3;
  constexpr double kConductivityFactor = 60.0;  // 1 / (2 π ε₀ c) [Ω]
  const double wavelength_m = kSpeedOfLight_mps / link.carrier_hz;
  const double k_radpm = 2.0 * std::numbers::pi / wavelength_m;
  const double h_T_m = std::max(link.p_WT.z(), kLowest_m);
  const double h_R_m = std::max(link.p_WR.z(), kLowest_m);
  const double ground_m = (link.p_WT - link.p_WR).head<2>().norm();
  const double direct_m = std::max(std::hypot(ground_m, h_T_m - h_R_m), kNearest_m);
  const double reflected_m = std::hypot(ground_m, h_T_m + h_R_m);
  const double sin_psi = (h_T_m + h_R_m) / reflected_m;
  const double f_ghz = link.carrier_hz / 1e9;
  const Complex permittivity{
      ground_->a * std::pow(f_ghz, ground_->b),
      -kConductivityFactor * wavelength_m * ground_->c * std::pow(f_ghz, ground_->d)};
  const Complex root = std::sqrt(permittivity - (1.0 - sin_psi * sin_psi));
  const Complex into =
      (polarisation_ == Polarisation::kVertical ? permittivity : Complex{1.0}) * sin_psi;
  const double rough = k_radpm * roughness_m_ * sin_psi;
  const Complex reflection = (into - root) / (into + root) * std::exp(-2.0 * rough * rough);
  const Complex field =
      1.0 / direct_m +
      reflection * std::polar(1.0 / reflected_m, -k_radpm * (reflected_m - direct_m));
  const double gain = wavelength_m / (4.0 * std::numbers::pi) * std::abs(field);
  return std::max(Decibel{0.0}, -Decibel::from_ratio(gain * gain));
}

}  // namespace cuscus::netsim
