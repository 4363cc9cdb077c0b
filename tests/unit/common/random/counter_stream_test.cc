#include "common/random/counter_stream.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace cuscus::random {
namespace {

constexpr int kDraws = 100'000;

TEST_CASE("a draw depends on seed, stream and index alone") {
  const CounterStream stream{7, stream_id(1, 3)};

  CHECK(stream.bits(5) == CounterStream{7, stream_id(1, 3)}.bits(5));
  CHECK(stream.bits(5) != stream.bits(6));
  CHECK(stream.bits(5) != CounterStream{8, stream_id(1, 3)}.bits(5));
  CHECK(stream.bits(5) != CounterStream{7, stream_id(1, 4)}.bits(5));
  CHECK(stream.bits(5) != CounterStream{7, stream_id(2, 3)}.bits(5));
}

TEST_CASE("uniform draws have the mean and variance of U(0, 1)") {
  const CounterStream stream{1, stream_id(1, 0)};
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = stream.uniform(static_cast<std::uint64_t>(i));
    REQUIRE((u >= 0.0 && u < 1.0));
    sum += u;
    squares += u * u;
  }
  const double mean = sum / kDraws;

  // Four standard errors: sqrt(1/12 / 1e5) = 0.00091; variance likewise, sqrt(1/180 / 1e5) =
  // 0.00024.
  CHECK(mean == Approx(0.5).margin(0.0037));
  CHECK(squares / kDraws - mean * mean == Approx(1.0 / 12.0).margin(0.001));
}

TEST_CASE("normal draws have mean 0, variance 1 and normal tails") {
  const CounterStream stream{1, stream_id(2, 0)};
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = stream.normal(static_cast<std::uint64_t>(i));
    sum += x;
    squares += x * x;
    beyond_two += std::abs(x) > 2.0 ? 1 : 0;
  }

  // Four standard errors: 1/sqrt(1e5) = 0.0032, sqrt(2/1e5) = 0.0045, sqrt(.0455*.9545/1e5) =
  // .00066.
  CHECK(sum / kDraws == Approx(0.0).margin(0.0127));
  CHECK(squares / kDraws == Approx(1.0).margin(0.018));
  CHECK(static_cast<double>(beyond_two) / kDraws == Approx(0.0455).margin(0.0027));
}

TEST_CASE("below reaches every value of its range and none outside") {
  const CounterStream stream{1, stream_id(3, 0)};
  std::array<int, 16> seen{};
  for (std::uint64_t i = 0; i < 16'000; ++i) {
    ++seen.at(stream.below(i, 16));
  }

  for (const int count : seen) {
    CHECK(count == Approx(1000).margin(4.0 * std::sqrt(1000.0)));
  }
}

}  // namespace
}  // namespace cuscus::random
