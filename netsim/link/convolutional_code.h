#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// A bit, 0 or 1.
using Bit = std::uint8_t;

/// The convolutional code of OFDM: constraint length 7, generators 133 and 171 (octal), punctured
/// to rates 2/3 and 3/4, begun and ended in state 0 by six tail bits.
///
/// Source: IEEE Std 802.11-2016, 17.3.5.6. Checked in
/// tests/unit/netsim/link/convolutional_code_test.cc.
class ConvolutionalCode {
 public:
  static constexpr std::size_t kTailBits = 6;

  /// @throws std::invalid_argument for CodeRate::kUncoded.
  explicit ConvolutionalCode(CodeRate rate);

  /// Coded bits of `bits`, whose last six should be 0.
  [[nodiscard]] std::vector<Bit> encode(std::span<const Bit> bits) const;
  /// How many coded bits so many bits become.
  [[nodiscard]] std::size_t coded_bits(std::size_t bits) const;

  /// The most likely bits (Viterbi's algorithm over the whole frame). `metrics` has one soft value
  /// per coded bit, positive for 1: the logarithm of its likelihood ratio but for a common factor.
  [[nodiscard]] std::vector<Bit> decode(std::span<const float> metrics, std::size_t bits) const;

 private:
  struct Kept {
    bool first;   ///< Output of generator 133.
    bool second;  ///< Of 171.
  };
  std::span<const Kept> pattern_;  ///< What puncturing leaves of successive bits; repeated.
};

}  // namespace cuscus::netsim
