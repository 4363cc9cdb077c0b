#pragma once

#include <array>
#include <cstdint>

#include "common/units/decibel.h"
#include "netsim/channel/link.h"

namespace cuscus::netsim {

/// Large-scale variation around the basic loss: a Gaussian random field over the positions of both
/// ends [dB], with mean 0, standard deviation σ and
///
///   E[S(r_L, r_H) S(r_L', r_H')] = σ² exp(-|r_L - r_L'| / d) exp(-|r_H - r_H'| / d),
///
/// d the decorrelation distance; realised as σ √(2/M) Σ_i cos(a_i·r_L + b_i·r_H + φ_i), the spatial
/// frequencies a_i and b_i drawn from the spectrum of the exponential, which in three dimensions is
/// the Cauchy distribution of scale 1/d, the phases uniform. Links whose ends are near those of
/// another see nearly the same shadows, as in a real place. There is no state: the same positions
/// give the same loss in whatever order they are visited.
///
/// Sources: M. Gudmundson, Electronics Letters 27(23), 1991 (the exponential); X. Cai, G. B.
/// Giannakis, IEEE Trans. Wireless Commun. 2(6), 2003 (the sum of sinusoids). Decorrelation
/// distances of 3GPP TR 38.901: 37 to 50 m urban macro, 10 to 13 m urban micro.
class Shadowing final {
 public:
  /// Fields of different purposes are independent.
  enum class Purpose : std::uint8_t { kShadows, kVisibility };
  struct Parameters {
    double deviation_db{0.0};
    double decorrelation_m{20.0};
    std::uint64_t seed{1};
    Purpose purpose{Purpose::kShadows};
  };

  explicit Shadowing(const Parameters& parameters);

  [[nodiscard]] Decibel loss(const Link& link) const;

 private:
  static constexpr std::size_t kWaves = 64;
  struct Wave {
    Eigen::Vector3d at_low;   ///< [rad/m]
    Eigen::Vector3d at_high;  ///< [rad/m]
    double phase_rad;
  };

  double amplitude_db_;
  std::array<Wave, kWaves> waves_{};
};

}  // namespace cuscus::netsim
