#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "netsim/phy/error_model.h"

namespace cuscus::netsim {
namespace {

constexpr double kNoiseBandwidth_MHz = 20.0;
constexpr double kChipRate_MHz = 11.0;
constexpr std::size_t kChips = 8;

double dqpsk(double bit_snr) {
  // Beyond this the result is below 10^-50, and the Bessel functions overflow.
  constexpr double kCertain = 200.0;
  if (bit_snr > kCertain) {
    return 0.0;
  }
  const double a2 = 2.0 * bit_snr * (1.0 - std::numbers::sqrt2 / 2.0);
  const double b2 = 2.0 * bit_snr * (1.0 + std::numbers::sqrt2 / 2.0);
  if (bit_snr <= 0.0) {
    return 0.5;
  }
  // Q₁(a, b) = e^(-(a²+b²)/2) Σ_k (a/b)^k I_k(ab), for a < b.
  const double ratio = std::sqrt(a2 / b2);
  const double ab = std::sqrt(a2 * b2);
  double sum = 0.5 * std::cyl_bessel_i(0.0, ab);
  double power = 1.0;
  constexpr double kNegligible = 1e-17;
  double term = sum;
  for (int k = 1; term > kNegligible * sum; ++k) {
    power *= ratio;
    term = power * std::cyl_bessel_i(static_cast<double>(k), ab);
    sum += term;
  }
  return std::min(0.5, std::exp(-0.5 * (a2 + b2)) * sum);
}

using CodeWord = std::array<std::complex<double>, kChips>;

/// Phases in quarter turns.
CodeWord code_word(int phase1, int phase2, int phase3, int phase4) {
  const auto chip = [](int quarters) {
    constexpr std::array<std::complex<double>, 4> kTurns{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return kTurns[static_cast<std::size_t>(quarters) % 4];
  };
  return {chip(phase1 + phase2 + phase3 + phase4),
          chip(phase1 + phase3 + phase4),
          chip(phase1 + phase2 + phase4),
          -chip(phase1 + phase4),
          chip(phase1 + phase2 + phase3),
          chip(phase1 + phase3),
          -chip(phase1 + phase2),
          chip(phase1)};
}

/// How many code words lie at which squared distance from one of them, in units of a chip's energy.
/// Which one does not matter: the words are products of phases.
struct Neighbours {
  double squared_distance;
  double count;
};

std::vector<Neighbours> neighbours_of(std::span<const CodeWord> words) {
  std::map<long, double> counts;
  for (const CodeWord& word : words.subspan(1)) {
    double squared = 0.0;
    for (std::size_t chip = 0; chip < kChips; ++chip) {
      squared += std::norm(word[chip] - words.front()[chip]);
    }
    counts[std::lround(squared)] += 1.0;
  }
  std::vector<Neighbours> neighbours;
  neighbours.reserve(counts.size());
  for (const auto& [squared, count] : counts) {
    neighbours.push_back({static_cast<double>(squared), count});
  }
  return neighbours;
}

/// 4 bits: φ1 and, of two bits, φ2 = π d2 + π/2, φ3 = 0, φ4 = π d3 [16.3.6.6.3].
std::vector<Neighbours> cck5_5_neighbours() {
  std::vector<CodeWord> words;
  for (int phase1 = 0; phase1 < 4; ++phase1) {
    for (int bits = 0; bits < 4; ++bits) {
      words.push_back(code_word(phase1, 2 * (bits / 2) + 1, 0, 2 * (bits % 2)));
    }
  }
  return neighbours_of(words);
}

/// 8 bits: four phases of two bits each [16.3.6.6.4].
std::vector<Neighbours> cck11_neighbours() {
  constexpr int kWords = 256;
  std::vector<CodeWord> words;
  words.reserve(kWords);
  for (int bits = 0; bits < kWords; ++bits) {
    words.push_back(code_word(bits / 64, bits / 16 % 4, bits / 4 % 4, bits % 4));
  }
  return neighbours_of(words);
}

double cck(std::span<const Neighbours> neighbours, double bits_per_word, double sinr_ratio) {
  const double chip_snr = sinr_ratio * kNoiseBandwidth_MHz / kChipRate_MHz;
  double word_failure = 0.0;
  for (const Neighbours& at : neighbours) {
    // Q(x) = ½ erfc(x / √2)
    word_failure += at.count * 0.5 * std::erfc(std::sqrt(at.squared_distance * chip_snr / 4.0));
  }
  return -std::expm1(std::log1p(-std::min(word_failure, 1.0)) / bits_per_word);
}

}  // namespace

double dsss_bit_failure(Modulation modulation, double sinr_ratio) {
  switch (modulation) {
    case Modulation::kDbpsk:
      return 0.5 * std::exp(-sinr_ratio * kNoiseBandwidth_MHz);
    case Modulation::kDqpsk:
      return dqpsk(sinr_ratio * kNoiseBandwidth_MHz / 2.0);
    case Modulation::kCck4Bit: {
      static const auto kNeighbours = cck5_5_neighbours();
      return cck(kNeighbours, 4.0, sinr_ratio);
    }
    case Modulation::kCck8Bit: {
      static const auto kNeighbours = cck11_neighbours();
      return cck(kNeighbours, 8.0, sinr_ratio);
    }
    default:
      return 1.0;  // not a modulation of DSSS
  }
}

}  // namespace cuscus::netsim
