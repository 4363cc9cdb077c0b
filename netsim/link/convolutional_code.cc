#include "netsim/link/convolutional_code.h"

#include <array>
#include <bit>
#include <limits>
#include <stdexcept>

namespace cuscus::netsim {
namespace {

// A state is the last six bits, the latest in bit 5. With the bit that comes in bit 6 above it:
constexpr std::uint32_t kFirstGenerator = 0133;
constexpr std::uint32_t kSecondGenerator = 0171;
constexpr std::size_t kStates = 64;
constexpr std::size_t kPairs = kStates / 2;

Bit parity(std::uint32_t word) { return static_cast<Bit>(std::popcount(word) & 1); }

/// What the encoder gives from state 2j with a 0 coming in, as signs.
///
/// Both generators take the oldest and the newest bit, so that flipping either flips both outputs:
/// these 32 pairs of signs say all of the 128 branches.
struct Signs {
  std::array<float, kPairs> first{};
  std::array<float, kPairs> second{};
};

Signs branch_signs() {
  Signs signs;
  for (std::uint32_t j = 0; j < kPairs; ++j) {
    signs.first[j] = parity(2 * j & kFirstGenerator) != 0 ? 1.0F : -1.0F;
    signs.second[j] = parity(2 * j & kSecondGenerator) != 0 ? 1.0F : -1.0F;
  }
  return signs;
}

using Metrics = std::array<float, kStates>;

/// One step of the trellis; bit s of the result: the better predecessor of state s was the odd one.
std::uint64_t advance(Metrics& metrics, const Signs& signs, float first, float second) {
  Metrics next;
  std::uint64_t odd = 0;
  for (std::size_t j = 0; j < kPairs; ++j) {
    const float branch = signs.first[j] * first + signs.second[j] * second;
    const float even_0 = metrics[2 * j] + branch;
    const float odd_0 = metrics[2 * j + 1] - branch;
    const float even_1 = metrics[2 * j] - branch;
    const float odd_1 = metrics[2 * j + 1] + branch;
    odd |= static_cast<std::uint64_t>(odd_0 > even_0) << j;
    odd |= static_cast<std::uint64_t>(odd_1 > even_1) << (j + kPairs);
    next[j] = odd_0 > even_0 ? odd_0 : even_0;
    next[j + kPairs] = odd_1 > even_1 ? odd_1 : even_1;
  }
  metrics = next;
  return odd;
}

}  // namespace

ConvolutionalCode::ConvolutionalCode(CodeRate rate) {
  static constexpr std::array<Kept, 1> kHalf{{{true, true}}};
  static constexpr std::array<Kept, 2> kTwoThirds{{{true, true}, {true, false}}};
  static constexpr std::array<Kept, 3> kThreeQuarters{{{true, true}, {true, false}, {false, true}}};
  switch (rate) {
    case CodeRate::kHalf:
      pattern_ = kHalf;
      return;
    case CodeRate::kTwoThirds:
      pattern_ = kTwoThirds;
      return;
    case CodeRate::kThreeQuarters:
      pattern_ = kThreeQuarters;
      return;
    case CodeRate::kUncoded:
      break;
  }
  throw std::invalid_argument{"convolutional code: the rate must be 1/2, 2/3 or 3/4"};
}

std::vector<Bit> ConvolutionalCode::encode(std::span<const Bit> bits) const {
  std::vector<Bit> coded;
  coded.reserve(2 * bits.size());
  std::uint32_t state = 0;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const Kept kept = pattern_[i % pattern_.size()];
    const std::uint32_t window = (std::uint32_t{bits[i]} << 6U) | state;
    if (kept.first) {
      coded.push_back(parity(window & kFirstGenerator));
    }
    if (kept.second) {
      coded.push_back(parity(window & kSecondGenerator));
    }
    state = window >> 1U;
  }
  return coded;
}

std::size_t ConvolutionalCode::coded_bits(std::size_t bits) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    const std::size_t times = bits / pattern_.size() + (i < bits % pattern_.size() ? 1 : 0);
    count += times * (std::size_t{pattern_[i].first} + std::size_t{pattern_[i].second});
  }
  return count;
}

std::vector<Bit> ConvolutionalCode::decode(std::span<const float> metrics, std::size_t bits) const {
  static const Signs kSigns = branch_signs();
  Metrics best;
  best.fill(-std::numeric_limits<float>::infinity());
  best[0] = 0.0F;
  std::vector<std::uint64_t> odd(bits);
  std::size_t next = 0;
  for (std::size_t i = 0; i < bits; ++i) {
    const Kept kept = pattern_[i % pattern_.size()];
    const float first = kept.first ? metrics[next++] : 0.0F;
    const float second = kept.second ? metrics[next++] : 0.0F;
    odd[i] = advance(best, kSigns, first, second);
    // Only differences matter; left alone, the sums would outgrow a float's digits.
    constexpr std::size_t kRebasePeriod = 64;
    if (i % kRebasePeriod == kRebasePeriod - 1) {
      const float base = best[0];
      for (float& metric : best) {
        metric -= base;
      }
    }
  }
  std::vector<Bit> decoded(bits);
  std::size_t state = 0;
  for (std::size_t i = bits; i-- > 0;) {
    decoded[i] = static_cast<Bit>(state >= kPairs);
    state = 2 * (state % kPairs) + ((odd[i] >> state) & 1U);
  }
  return decoded;
}

}  // namespace cuscus::netsim
