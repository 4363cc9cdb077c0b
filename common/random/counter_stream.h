#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "common/random/philox.h"

namespace cuscus::random {

/// Random numbers keyed by (seed, stream, index): draw `index` of a stream is the same whatever was
/// drawn before, in whatever thread. A stream is one purpose of one object, such as the backoff of
/// node 3; stream_id() makes its number.
class CounterStream {
 public:
  constexpr CounterStream(std::uint64_t seed, std::uint64_t stream) noexcept
      : seed_{seed}, stream_{stream} {}

  /// 64 uniform bits.
  [[nodiscard]] std::uint64_t bits(std::uint64_t index) const noexcept {
    const auto block = philox4x32({low(index), high(index), low(stream_), high(stream_)},
                                  {low(seed_), high(seed_)});
    return (static_cast<std::uint64_t>(block[1]) << 32U) | block[0];
  }

  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform(std::uint64_t index) const noexcept {
    return static_cast<double>(bits(index) >> 11U) * 0x1p-53;
  }

  /// Uniform integer in [0, bound). Bias below bound / 2^32.
  [[nodiscard]] std::uint32_t below(std::uint64_t index, std::uint32_t bound) const noexcept {
    return static_cast<std::uint32_t>(((bits(index) >> 32U) * bound) >> 32U);
  }

  /// Standard normal (Box-Muller, one of the pair, so that draws stay independent of each other).
  [[nodiscard]] double normal(std::uint64_t index) const noexcept {
    const auto block = philox4x32({low(index), high(index), low(stream_), high(stream_)},
                                  {low(seed_), high(seed_)});
    const double u = (static_cast<double>(block[0]) + 0.5) * 0x1p-32;
    const double v = static_cast<double>(block[2]) * 0x1p-32;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  static constexpr std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  static constexpr std::uint32_t high(std::uint64_t x) {
    return static_cast<std::uint32_t>(x >> 32U);
  }

  std::uint64_t seed_;
  std::uint64_t stream_;
};

/// Number of the stream for `purpose` of object `object` (of a link: `object` and `other`).
[[nodiscard]] constexpr std::uint64_t stream_id(std::uint16_t purpose, std::uint32_t object,
                                                std::uint16_t other = 0) noexcept {
  return (static_cast<std::uint64_t>(purpose) << 48U) | (static_cast<std::uint64_t>(other) << 32U) |
         object;
}

}  // namespace cuscus::random
