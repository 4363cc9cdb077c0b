#pragma once

#include <array>
#include <cstdint>

#include "proto/report.pb.h"

namespace cuscus::netsim {

/// Durations by size: constant time and memory, quantiles within 1/16 of their value.
class DurationHistogram {
 public:
  /// Negative durations count as 0.
  void add(std::int64_t duration_ns) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t max_ns() const noexcept { return max_ns_; }
  /// The smallest bin border that at least the fraction `q` of all samples lies below; 0 without
  /// samples, never above max_ns().
  [[nodiscard]] std::int64_t quantile_ns(double q) const noexcept;
  [[nodiscard]] proto::DurationSummary summary() const;

 private:
  static constexpr unsigned kSubBits = 4;
  static constexpr std::size_t kSubBins = std::size_t{1} << kSubBits;

  static std::size_t bin_of(std::uint64_t duration_ns) noexcept;
  static std::int64_t upper_border_ns(std::size_t bin) noexcept;

  std::array<std::uint64_t, 64 * kSubBins> bins_{};
  std::uint64_t count_{0};
  std::int64_t max_ns_{0};
};

}  // namespace cuscus::netsim
