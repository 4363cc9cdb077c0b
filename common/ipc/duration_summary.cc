#include "common/ipc/duration_summary.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace cuscus::ipc {

proto::DurationSummary summary_of(const statistics::Log2Histogram& histogram) {
  proto::DurationSummary summary;
  if (histogram.count() == 0) {
    return summary;
  }
  summary.set_count(histogram.count());
  summary.set_p50_ns(histogram.quantile_ns(0.5));
  summary.set_p99_ns(histogram.quantile_ns(0.99));
  summary.set_p999_ns(histogram.quantile_ns(0.999));
  summary.set_max_ns(histogram.max_ns());
  const auto octaves = histogram.octaves();
  // "| 1": what is below 1 ns is in the first octave too.
  const auto used =
      static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(histogram.max_ns()) | 1U));
  for (std::size_t octave = 0; octave < used; ++octave) {
    summary.add_log2_bins(octaves.at(octave));
  }
  return summary;
}

}  // namespace cuscus::ipc
