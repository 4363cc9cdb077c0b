#include "netsim/app/duration_histogram.h"

#include <catch2/catch.hpp>

namespace cuscus::netsim {
namespace {

TEST_CASE("quantiles are within a sixteenth above the exact ones") {
  DurationHistogram histogram;
  for (std::int64_t i = 1; i <= 100'000; ++i) {
    histogram.add(i);
  }

  const auto close = [&](double q, std::int64_t exact) {
    return histogram.quantile_ns(q) >= exact && histogram.quantile_ns(q) <= exact + exact / 16 + 1;
  };
  CHECK(close(0.5, 50'000));
  CHECK(close(0.99, 99'000));
  CHECK(histogram.quantile_ns(1.0) == 100'000);
  CHECK(histogram.max_ns() == 100'000);
}

TEST_CASE("the summary counts samples per power of two") {
  DurationHistogram histogram;
  for (const std::int64_t sample : {-5, 0, 1, 2, 3, 4, 1024, 2047}) {
    histogram.add(sample);
  }

  const auto summary = histogram.summary();
  CHECK(summary.count() == 8);
  REQUIRE(summary.log2_bins_size() == 11);
  CHECK(summary.log2_bins(0) == 3);
  CHECK(summary.log2_bins(1) == 2);
  CHECK(summary.log2_bins(2) == 1);
  CHECK(summary.log2_bins(10) == 2);
  CHECK(summary.max_ns() == 2047);
}

TEST_CASE("an empty histogram has no quantiles and no bins") {
  const auto summary = DurationHistogram{}.summary();

  CHECK(summary.count() == 0);
  CHECK(summary.p999_ns() == 0);
  CHECK(summary.log2_bins_size() == 0);
}

}  // namespace
}  // namespace cuscus::netsim
