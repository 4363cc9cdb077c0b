#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "common/random/counter_stream.h"
#include "common/units/decibel.h"
#include "netsim/link/constellation.h"
#include "netsim/link/convolutional_code.h"

namespace cuscus::netsim {

/// One OFDM link in white Gaussian noise, bit by bit: random bits, convolutional code, interleaver,
/// mapping, 48 data subcarriers, a channel estimated from the two long training symbols, soft
/// decisions, Viterbi.
///
/// Subcarrier by subcarrier, since a Fourier transform leaves white noise white. The SNR is that of
/// the whole channel: the signal's power over the noise in all 64 subcarrier spacings, of which it
/// fills 52, so that a subcarrier has 64/52 of it. The estimate of a subcarrier is the mean of the
/// two training symbols, and has half the noise's variance.
///
/// Leaves out: frequency offset and phase noise (taken as tracked perfectly), timing errors,
/// quantisation and non-linear amplifiers; interference is taken as noise.
class OfdmLink {
 public:
  /// @throws std::invalid_argument for modulations and code rates that are not OFDM's.
  OfdmLink(Modulation modulation, CodeRate code_rate, std::uint64_t seed);

  /// Sends frame `number` of so many bits, tail aside, and says whether all arrived right.
  [[nodiscard]] bool survives(std::uint64_t number, std::size_t bits, Decibel snr) const;

 private:
  using Points = std::vector<std::complex<float>>;

  [[nodiscard]] std::vector<float> receive(const random::CounterStream& draws, const Points& sent,
                                           Decibel snr) const;

  Constellation constellation_;
  ConvolutionalCode code_;
  std::uint64_t seed_;
};

}  // namespace cuscus::netsim
