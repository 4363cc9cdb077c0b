#pragma once

#include <array>
#include <cstdint>

#include "netsim/channel/link.h"

namespace cuscus::netsim {

/// A Gaussian random field over the positions of both ends of a link, with mean 0, variance 1 and
///
///   E[G(r_L, r_H) G(r_L', r_H')] = exp(-|r_L - r_L'| / d) exp(-|r_H - r_H'| / d),
///
/// d the decorrelation distance; realised as √(2/M) Σ_i cos(a_i·r_L + b_i·r_H + φ_i), the spatial
/// frequencies a_i and b_i drawn from the spectrum of the exponential, which in three dimensions is
/// the Cauchy distribution of scale 1/d, the phases uniform. Links whose ends are near those of
/// another see nearly the same value. There is no state: the same positions give the same value in
/// whatever order they are visited.
///
/// Source: X. Cai, G. B. Giannakis, IEEE Trans. Wireless Commun. 2(6), 2003. Checked in
/// tests/validation/netsim/fading_test.cc.
class GaussianField final {
 public:
  struct Parameters {
    std::uint16_t purpose{};  ///< Of its random stream (see random::stream_id).
    double decorrelation_m{20.0};
    std::uint64_t seed{1};
  };

  explicit GaussianField(const Parameters& parameters);

  [[nodiscard]] double value(const Eigen::Vector3d& p_WL, const Eigen::Vector3d& p_WH) const;

 private:
  static constexpr std::size_t kWaves = 64;
  struct Wave {
    Eigen::Vector3d at_low;   ///< [rad/m]
    Eigen::Vector3d at_high;  ///< [rad/m]
    double phase_rad;
  };

  std::array<Wave, kWaves> waves_{};
};

}  // namespace cuscus::netsim
