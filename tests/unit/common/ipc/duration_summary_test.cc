#include "common/ipc/duration_summary.h"

#include <catch2/catch.hpp>

namespace cuscus::ipc {
namespace {

TEST_CASE("the summary counts samples per power of two") {
  statistics::Log2Histogram histogram;
  for (const std::int64_t sample : {-5, 0, 1, 2, 3, 4, 1024, 2047}) {
    histogram.add(sample);
  }

  const auto summary = summary_of(histogram);

  CHECK(summary.count() == 8);
  REQUIRE(summary.log2_bins_size() == 11);
  CHECK(summary.log2_bins(0) == 3);
  CHECK(summary.log2_bins(1) == 2);
  CHECK(summary.log2_bins(2) == 1);
  CHECK(summary.log2_bins(10) == 2);
  CHECK(summary.max_ns() == 2047);
}

TEST_CASE("the summary's quantiles are within a sixteenth above the exact ones") {
  statistics::Log2Histogram histogram;
  for (std::int64_t i = 1; i <= 100'000; ++i) {
    histogram.add(i);
  }

  const auto summary = summary_of(histogram);

  const auto close = [](std::int64_t given, std::int64_t exact) {
    return given >= exact && given <= exact + exact / 16 + 1;
  };
  CHECK(close(summary.p50_ns(), 50'000));
  CHECK(close(summary.p99_ns(), 99'000));
  CHECK(close(summary.p999_ns(), 99'900));
  CHECK(summary.max_ns() == 100'000);
}

TEST_CASE("without samples there are no quantiles and no bins") {
  const auto summary = summary_of(statistics::Log2Histogram{});

  CHECK(summary.count() == 0);
  CHECK(summary.p999_ns() == 0);
  CHECK(summary.log2_bins_size() == 0);
}

}  // namespace
}  // namespace cuscus::ipc
