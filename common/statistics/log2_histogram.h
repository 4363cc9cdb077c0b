#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cuscus::statistics {

/// Counts durations in bins whose width grows with the duration: each power of two is cut into
/// sixteen, so that a quantile is known to 1/16 of itself from 1 ns to 292 years. Adding is a few
/// instructions and never allocates.
class Log2Histogram {
 public:
  static constexpr std::size_t kOctaves = 64;

  /// A negative duration counts as 0.
  void add(std::int64_t duration_ns) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t max_ns() const noexcept { return max_ns_; }

  /// The duration that a `fraction` (0 ... 1) of all samples do not exceed: the upper edge of its
  /// bin, but never more than max_ns(). 0 when there is no sample.
  [[nodiscard]] std::int64_t quantile_ns(double fraction) const noexcept;

  /// Samples per power of two: entry k counts [2^k, 2^(k+1)) ns, entry 0 also everything below 1
  /// ns.
  [[nodiscard]] std::array<std::uint64_t, kOctaves> octaves() const noexcept;

 private:
  static constexpr std::size_t kSubBinBits = 4;
  static constexpr std::size_t kSubBins = std::size_t{1} << kSubBinBits;
  static constexpr std::size_t kBins = (kOctaves - kSubBinBits + 1) * kSubBins;

  [[nodiscard]] static std::size_t bin_of(std::uint64_t duration_ns) noexcept;
  [[nodiscard]] static std::uint64_t last_of(std::size_t bin) noexcept;

  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_{0};
  std::int64_t max_ns_{0};
};

}  // namespace cuscus::statistics
