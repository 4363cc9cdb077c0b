#include "common/statistics/log2_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cuscus::statistics {

void Log2Histogram::add(std::int64_t duration_ns) noexcept {
  const std::int64_t duration = std::max<std::int64_t>(duration_ns, 0);
  ++bins_[bin_of(static_cast<std::uint64_t>(duration))];
  ++count_;
  max_ns_ = std::max(max_ns_, duration);
}

// Durations below 16 ns have a bin each; above, a bin is the exponent and the four bits after the
// leading one.
std::size_t Log2Histogram::bin_of(std::uint64_t duration_ns) noexcept {
  if (duration_ns < kSubBins) {
    return static_cast<std::size_t>(duration_ns);
  }
  const auto exponent = static_cast<std::size_t>(std::bit_width(duration_ns)) - 1;
  const auto sub_bin = static_cast<std::size_t>(duration_ns >> (exponent - kSubBinBits)) % kSubBins;
  return (exponent - kSubBinBits + 1) * kSubBins + sub_bin;
}

std::uint64_t Log2Histogram::last_of(std::size_t bin) noexcept {
  if (bin < kSubBins) {
    return bin;
  }
  const std::size_t shift = bin / kSubBins - 1;
  return ((kSubBins + bin % kSubBins + 1) << shift) - 1;
}

std::int64_t Log2Histogram::quantile_ns(double fraction) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(
      std::ceil(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    seen += bins_[bin];
    if (seen != 0 && seen >= wanted) {
      return std::min(static_cast<std::int64_t>(last_of(bin)), max_ns_);
    }
  }
  return max_ns_;
}

std::array<std::uint64_t, Log2Histogram::kOctaves> Log2Histogram::octaves() const noexcept {
  std::array<std::uint64_t, kOctaves> octaves{};
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const auto width = static_cast<std::size_t>(std::bit_width(last_of(bin)));
    octaves[std::max<std::size_t>(width, 1) - 1] += bins_[bin];
  }
  return octaves;
}

}  // namespace cuscus::statistics
