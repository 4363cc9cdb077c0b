#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "common/random/counter_stream.h"
#include "common/units/decibel.h"
#include "netsim/channel/link.h"

namespace cuscus::netsim {

/// Small-scale attenuation of one frame, 0 dB on average of the powers. The channel is flat over
/// the band and constant over a frame.
class FadingModel {
 public:
  virtual ~FadingModel() = default;

  /// A loss; negative where waves add up.
  [[nodiscard]] virtual Decibel loss(const FrameOnLink& frame) const = 0;
  /// No frame ever gains more than this; +inf: there is no bound.
  [[nodiscard]] virtual Decibel greatest_gain() const = 0;
};

/// Rice and Rayleigh fading as a sum of plane waves at both ends of the link,
///
///   h = √(K/(K+1)) e^(jkd) + √(1/((K+1) N)) Σ_i e^(j(φ_i + k (u_i·r_L + w_i·r_H) + 2π f_i t)),
///   loss = -20 log₁₀ |h|  dB,
///
/// with k = 2π/λ, d the distance of the ends, r_L and r_H their positions, u_i and w_i the
/// directions of wave i at either end: azimuths spread evenly over the circle, elevations within
/// ±20°; φ_i hashed from (seed, link), f_i from ± the residual Doppler, K the ratio of the direct
/// wave's power to that of all others.
///
/// The phases turn with position, not with time: a node that moves at v fades at the Doppler
/// frequency v/λ whatever its path, retries of one frame see almost the same channel, and two nodes
/// that stand still would see the same one for ever, but for the residual Doppler, which stands for
/// an environment that moves. There is no state; direction and order of frames do not matter.
///
/// Source: W. C. Jakes, "Microwave Mobile Communications", 1974, chapter 1, with both ends moving
/// as in A. S. Akki, F. Haber, IEEE Trans. Veh. Technol. 35(1), 1986. K grows from the horizon to
/// the zenith as K(θ) = K₀ (K₉₀/K₀)^(2θ/π), θ the elevation of one end seen from the other
/// [M. M. Azari et al., IEEE Trans. Commun. 66(1), 2018].
/// With N = 16 waves deep fades are rarer than in theory: P(< -10 dB) of Rayleigh is 0.093 instead
/// of 0.095, and the power's correlation is lower by up to 1/16. Checked in
/// tests/validation/netsim/fading_test.cc.
class RiceFading final : public FadingModel {
 public:
  struct Parameters {
    Decibel k_at_horizon{};  ///< -inf: Rayleigh.
    Decibel k_at_zenith{};
    double residual_doppler_hz{1.0};
    double carrier_hz{2.437e9};
    std::uint64_t seed{1};
  };

  explicit RiceFading(const Parameters& parameters);

  [[nodiscard]] Decibel loss(const FrameOnLink& frame) const override;
  /// All waves in phase: |h|² ≤ (√K + √N)² / (K + 1) ≤ N + 1.
  [[nodiscard]] Decibel greatest_gain() const override { return Decibel::from_ratio(kWaves + 1.0); }

  /// Power ratio of the direct wave to the others at an elevation, 0 ... π/2.
  [[nodiscard]] double k_factor(double elevation_rad) const;

 private:
  static constexpr std::size_t kWaves = 16;
  struct Wave {
    Eigen::Vector3d at_low;   ///< k u [rad/m].
    Eigen::Vector3d at_high;  ///< k w [rad/m].
    double turn_radps;        ///< 2π f.
  };

  Parameters parameters_;
  double wave_number_radpm_;
  std::array<Wave, kWaves> waves_{};
};

/// Nakagami-m fading, drawn anew for every transmission: received power is Gamma distributed with
/// shape m and mean 1. No correlation in time or space: for comparison with simulators that do it
/// so. Rice with a ratio K resembles m = (K+1)² / (2K+1).
///
/// Source: M. Nakagami, "The m-distribution", 1960; Gamma variates: G. Marsaglia, W. W. Tsang, ACM
/// Trans. Math. Softw. 26(3), 2000.
class NakagamiFading final : public FadingModel {
 public:
  /// m of at least 0.5.
  NakagamiFading(std::uint64_t seed, double m) : seed_{seed}, m_{m} {}

  [[nodiscard]] Decibel loss(const FrameOnLink& frame) const override;
  [[nodiscard]] Decibel greatest_gain() const override {
    return {std::numeric_limits<double>::infinity()};
  }

 private:
  std::uint64_t seed_;
  double m_;
};

/// Stream and index of what is drawn anew for each transmission over a link, in either direction.
struct FrameDraw {
  random::CounterStream stream;
  std::uint64_t index;

  /// For `purpose` (see random::stream_id()).
  [[nodiscard]] static FrameDraw of(std::uint64_t seed, std::uint16_t purpose,
                                    const FrameOnLink& frame);
};

}  // namespace cuscus::netsim
