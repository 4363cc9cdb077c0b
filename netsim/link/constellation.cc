#include "netsim/link/constellation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cuscus::netsim {
namespace {

std::size_t bits_of(Modulation modulation) {
  switch (modulation) {
    case Modulation::kBpsk:
      return 1;
    case Modulation::kQpsk:
      return 2;
    case Modulation::k16Qam:
      return 4;
    case Modulation::k64Qam:
      return 6;
    default:
      throw std::invalid_argument{"constellation: the modulation must be OFDM's"};
  }
}

/// -(L-1), ..., L-1 in Gray's order: neighbours differ in one bit.
std::vector<float> gray_levels(std::size_t axis_bits, std::size_t all_bits) {
  const std::size_t count = std::size_t{1} << axis_bits;
  // Mean of the squared levels of one axis is (L^2 - 1) / 3; BPSK has one axis, the rest two.
  const double axes = all_bits == 1 ? 1.0 : 2.0;
  const auto l = static_cast<double>(count);
  const double scale = 1.0 / std::sqrt(axes * (l * l - 1.0) / 3.0);
  std::vector<float> levels(count);
  for (std::size_t rank = 0; rank < count; ++rank) {
    const std::size_t gray = rank ^ (rank >> 1U);
    levels[gray] = static_cast<float>(scale * (2.0 * static_cast<double>(rank) - (l - 1.0)));
  }
  return levels;
}

std::vector<std::size_t> interleaving(std::size_t bits) {
  const std::size_t n = bits * kDataSubcarriers;
  const std::size_t s = std::max<std::size_t>(bits / 2, 1);
  std::vector<std::size_t> place(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (n / 16) * (k % 16) + k / 16;
    place[k] = s * (i / s) + (i + n - 16 * i / n) % s;
  }
  return place;
}

}  // namespace

Constellation::Constellation(Modulation modulation)
    : bits_{bits_of(modulation)},
      levels_{gray_levels(bits_ == 1 ? 1 : bits_ / 2, bits_)},
      place_{interleaving(bits_)} {}

void Constellation::map(std::span<const Bit> coded,
                        std::vector<std::complex<float>>& points) const {
  std::vector<Bit> placed(bits_per_symbol());
  for (std::size_t k = 0; k < placed.size(); ++k) {
    placed[place_[k]] = coded[k];
  }
  const auto axis = [&](std::size_t first) {
    std::size_t group = 0;
    for (std::size_t b = 0; b < bits_per_axis(); ++b) {
      group = 2 * group + placed[first + b];
    }
    return level(group);
  };
  for (std::size_t c = 0; c < kDataSubcarriers; ++c) {
    const std::size_t first = c * bits_;
    points.emplace_back(axis(first), bits_ == 1 ? 0.0F : axis(first + bits_per_axis()));
  }
}

void Constellation::soft_axis(float value, float weight, float* metrics) const {
  constexpr std::size_t kMostBits = 3;
  std::array<std::array<float, 2>, kMostBits> nearest{};
  for (auto& of_bit : nearest) {
    of_bit.fill(std::numeric_limits<float>::infinity());
  }
  const std::size_t bits = bits_per_axis();
  for (std::size_t group = 0; group < levels_.size(); ++group) {
    const float difference = value - level(group);
    const float squared = difference * difference;
    for (std::size_t b = 0; b < bits; ++b) {
      float& least = nearest[b][(group >> (bits - 1 - b)) & 1U];
      least = std::min(least, squared);
    }
  }
  for (std::size_t b = 0; b < bits; ++b) {
    metrics[b] = weight * (nearest[b][0] - nearest[b][1]);
  }
}

void Constellation::demap(std::span<const std::complex<float>> points,
                          std::span<const float> weights, std::vector<float>& metrics) const {
  std::vector<float> placed(bits_per_symbol());
  for (std::size_t c = 0; c < kDataSubcarriers; ++c) {
    float* const first = placed.data() + c * bits_;
    soft_axis(points[c].real(), weights[c], first);
    if (bits_ > 1) {
      soft_axis(points[c].imag(), weights[c], first + bits_per_axis());
    }
  }
  for (std::size_t k = 0; k < placed.size(); ++k) {
    metrics.push_back(placed[place_[k]]);
  }
}

}  // namespace cuscus::netsim
