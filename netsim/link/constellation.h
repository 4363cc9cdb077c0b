#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "netsim/link/convolutional_code.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

inline constexpr std::size_t kDataSubcarriers = 48;

/// How the coded bits of an OFDM symbol get onto its 48 data subcarriers: interleaving and
/// Gray-coded mapping at mean power 1, and back to soft values.
///
/// Source: IEEE Std 802.11-2016, 17.3.5.7 (interleaver) and 17.3.5.8 (mapping). Checked in
/// tests/unit/netsim/link/constellation_test.cc.
class Constellation {
 public:
  /// @throws std::invalid_argument for modulations that are not OFDM's.
  explicit Constellation(Modulation modulation);

  [[nodiscard]] std::size_t bits_per_subcarrier() const { return bits_; }
  [[nodiscard]] std::size_t bits_per_symbol() const { return bits_ * kDataSubcarriers; }

  /// Appends the 48 points of one symbol.
  void map(std::span<const Bit> coded, std::vector<std::complex<float>>& points) const;

  /// Appends a soft value per coded bit of one symbol, positive for 1: the difference of squared
  /// distances to the nearest points with 0 and with 1 (max-log), times the subcarrier's `weight`.
  void demap(std::span<const std::complex<float>> points, std::span<const float> weights,
             std::vector<float>& metrics) const;

 private:
  /// One axis: the level of each group of bits, the first bit highest.
  [[nodiscard]] std::size_t bits_per_axis() const { return bits_ == 1 ? 1 : bits_ / 2; }
  [[nodiscard]] float level(std::size_t group) const { return levels_[group]; }
  void soft_axis(float value, float weight, float* metrics) const;

  std::size_t bits_;
  std::vector<float> levels_;
  std::vector<std::size_t> place_;  ///< On the subcarriers, of coded bit k.
};

}  // namespace cuscus::netsim
