#include "netsim/app/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cuscus::netsim {

std::size_t DurationHistogram::bin_of(std::uint64_t duration_ns) noexcept {
  const std::uint64_t value = std::max<std::uint64_t>(duration_ns, 1);
  const auto octave = static_cast<unsigned>(std::bit_width(value)) - 1;
  // The kSubBits bits below the highest one.
  const std::uint64_t sub = octave >= kSubBits ? (value >> (octave - kSubBits)) & (kSubBins - 1)
                                               : (value << (kSubBits - octave)) & (kSubBins - 1);
  return octave * kSubBins + static_cast<std::size_t>(sub);
}

std::int64_t DurationHistogram::upper_border_ns(std::size_t bin) noexcept {
  const double octave = std::ldexp(1.0, static_cast<int>(bin / kSubBins));
  const double border =
      octave * (1.0 + static_cast<double>(bin % kSubBins + 1) / static_cast<double>(kSubBins));
  return static_cast<std::int64_t>(std::min(border, 9e18));
}

void DurationHistogram::add(std::int64_t duration_ns) noexcept {
  const std::int64_t value = std::max<std::int64_t>(duration_ns, 0);
  ++bins_[bin_of(static_cast<std::uint64_t>(value))];
  ++count_;
  max_ns_ = std::max(max_ns_, value);
}

std::int64_t DurationHistogram::quantile_ns(double q) const noexcept {
  if (count_ == 0) {
    return 0;
  }
  const auto wanted = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    below += bins_[bin];
    if (below >= wanted) {
      return std::min(upper_border_ns(bin), max_ns_);
    }
  }
  return max_ns_;
}

proto::DurationSummary DurationHistogram::summary() const {
  proto::DurationSummary summary;
  summary.set_count(count_);
  summary.set_p50_ns(quantile_ns(0.5));
  summary.set_p99_ns(quantile_ns(0.99));
  summary.set_p999_ns(quantile_ns(0.999));
  summary.set_max_ns(max_ns_);
  const auto octaves = static_cast<std::size_t>(
      count_ == 0 ? 0
                  : std::bit_width(static_cast<std::uint64_t>(std::max<std::int64_t>(max_ns_, 1))));
  for (std::size_t octave = 0; octave < octaves; ++octave) {
    std::uint64_t sum = 0;
    for (std::size_t sub = 0; sub < kSubBins; ++sub) {
      sum += bins_[octave * kSubBins + sub];
    }
    summary.add_log2_bins(sum);
  }
  return summary;
}

}  // namespace cuscus::netsim
