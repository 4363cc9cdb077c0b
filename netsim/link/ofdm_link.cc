#include "netsim/link/ofdm_link.h"

#include <algorithm>
#include <cmath>

namespace cuscus::netsim {
namespace {

constexpr double kSubcarrierSpacings = 64.0;
constexpr double kSubcarriersInUse = 52.0;  // 48 of data and 4 pilots
constexpr std::size_t kBitsPerDraw = 64;

std::vector<Bit> random_bits(const random::CounterStream& draws, std::size_t count) {
  std::vector<Bit> bits(count);
  for (std::size_t i = 0; i < count; ++i) {
    bits[i] = static_cast<Bit>((draws.bits(i / kBitsPerDraw) >> (i % kBitsPerDraw)) & 1U);
  }
  return bits;
}

/// Circular Gaussian noise of that variance.
class Noise {
 public:
  Noise(const random::CounterStream& draws, double variance)
      : draws_{&draws}, deviation_{std::sqrt(variance / 2.0)} {}

  std::complex<float> next() {
    const double re = draws_->normal(index_++);
    const double im = draws_->normal(index_++);
    return {static_cast<float>(deviation_ * re), static_cast<float>(deviation_ * im)};
  }

 private:
  // Beyond what random_bits() draws of the same stream.
  static constexpr std::uint64_t kFirst = std::uint64_t{1} << 32U;

  const random::CounterStream* draws_;
  double deviation_;
  std::uint64_t index_{kFirst};
};

}  // namespace

OfdmLink::OfdmLink(Modulation modulation, CodeRate code_rate, std::uint64_t seed)
    : constellation_{modulation}, code_{code_rate}, seed_{seed} {}

std::vector<float> OfdmLink::receive(const random::CounterStream& draws, const Points& sent,
                                     Decibel snr) const {
  const double variance = 1.0 / (snr.ratio() * kSubcarrierSpacings / kSubcarriersInUse);
  Noise noise{draws, variance};
  std::vector<std::complex<float>> channel(kDataSubcarriers);
  std::vector<float> weights(kDataSubcarriers);
  for (std::size_t c = 0; c < kDataSubcarriers; ++c) {
    channel[c] = 1.0F + 0.5F * (noise.next() + noise.next());
    weights[c] = std::norm(channel[c]);
  }
  std::vector<float> metrics;
  metrics.reserve(sent.size() * constellation_.bits_per_subcarrier());
  Points symbol(kDataSubcarriers);
  for (std::size_t first = 0; first < sent.size(); first += kDataSubcarriers) {
    for (std::size_t c = 0; c < kDataSubcarriers; ++c) {
      symbol[c] = (sent[first + c] + noise.next()) / channel[c];
    }
    constellation_.demap(symbol, weights, metrics);
  }
  return metrics;
}

bool OfdmLink::survives(std::uint64_t number, std::size_t bits, Decibel snr) const {
  const random::CounterStream draws{seed_, number};
  std::vector<Bit> frame = random_bits(draws, bits);
  frame.resize(bits + ConvolutionalCode::kTailBits, 0);

  std::vector<Bit> coded = code_.encode(frame);
  const std::size_t per_symbol = constellation_.bits_per_symbol();
  coded.resize((coded.size() + per_symbol - 1) / per_symbol * per_symbol, 0);
  Points points;
  points.reserve(coded.size() / constellation_.bits_per_subcarrier());
  for (std::size_t first = 0; first < coded.size(); first += per_symbol) {
    constellation_.map(std::span{coded}.subspan(first, per_symbol), points);
  }

  const std::vector<float> metrics = receive(draws, points, snr);
  return code_.decode(metrics, frame.size()) == frame;
}

}  // namespace cuscus::netsim
