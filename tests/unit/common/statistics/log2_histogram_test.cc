#include "common/statistics/log2_histogram.h"

#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

namespace cuscus::statistics {
namespace {

TEST_CASE("a histogram without samples has no quantiles") {
  const Log2Histogram histogram;

  CHECK(histogram.count() == 0);
  CHECK(histogram.max_ns() == 0);
  CHECK(histogram.quantile_ns(0.5) == 0);
}

TEST_CASE("quantiles are above the truth by at most a sixteenth") {
  Log2Histogram histogram;
  for (std::int64_t duration_ns = 1; duration_ns <= 100'000; ++duration_ns) {
    histogram.add(duration_ns);
  }

  const double fraction = GENERATE(0.00005, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0);
  const double truth_ns = fraction * 100'000;
  CAPTURE(fraction);

  CHECK(static_cast<double>(histogram.quantile_ns(fraction)) >= truth_ns);
  CHECK(static_cast<double>(histogram.quantile_ns(fraction)) <= truth_ns * (1.0 + 1.0 / 16.0));
  CHECK(histogram.max_ns() == 100'000);
}

TEST_CASE("octaves hold the powers of two that they are named after") {
  Log2Histogram histogram;
  histogram.add(-5);
  histogram.add(0);
  histogram.add(1);
  histogram.add(2);
  histogram.add(3);
  histogram.add(1023);
  histogram.add(1024);
  histogram.add(std::numeric_limits<std::int64_t>::max());

  const auto octaves = histogram.octaves();

  CHECK(octaves[0] == 3);
  CHECK(octaves[1] == 2);
  CHECK(octaves[9] == 1);
  CHECK(octaves[10] == 1);
  CHECK(octaves[62] == 1);
  CHECK(std::accumulate(octaves.begin(), octaves.end(), std::uint64_t{0}) == histogram.count());
  CHECK(histogram.quantile_ns(1.0) == std::numeric_limits<std::int64_t>::max());
}

TEST_CASE("a rare long duration shows in the high quantiles and the maximum only") {
  Log2Histogram histogram;
  for (int i = 0; i < 999; ++i) {
    histogram.add(10'000);
  }
  histogram.add(5'000'000);

  CHECK(histogram.quantile_ns(0.5) < 10'700);
  CHECK(histogram.quantile_ns(0.999) < 10'700);
  CHECK(histogram.quantile_ns(0.9995) == 5'000'000);
}

}  // namespace
}  // namespace cuscus::statistics
