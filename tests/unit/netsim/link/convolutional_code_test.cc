#include "netsim/link/convolutional_code.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {
namespace {

std::vector<Bit> frame_of(std::uint64_t seed, std::size_t bits) {
  const random::CounterStream draws{seed, 0};
  std::vector<Bit> frame(bits);
  std::generate(frame.begin(), frame.end(), [&, i = std::uint64_t{0}]() mutable {
    return static_cast<Bit>(draws.below(i++, 2));
  });
  frame.resize(bits + ConvolutionalCode::kTailBits, 0);
  return frame;
}

/// Certain soft values of coded bits.
std::vector<float> certain(const std::vector<Bit>& coded) {
  std::vector<float> metrics;
  metrics.reserve(coded.size());
  for (const Bit bit : coded) {
    metrics.push_back(bit != 0 ? 1.0F : -1.0F);
  }
  return metrics;
}

TEST_CASE("a single 1 comes out as the two generators") {
  // 133 = 1 011 011 and 171 = 1 111 001, the newest bit first, output in turn.
  const std::vector<Bit> impulse{1, 0, 0, 0, 0, 0, 0};
  const std::vector<Bit> expected{1, 1, 0, 1, 1, 1, 1, 1, 0, 0, 1, 0, 1, 1};

  CHECK(ConvolutionalCode{CodeRate::kHalf}.encode(impulse) == expected);
  // Without every second output of 171; without the third of 133 and the second of 171.
  CHECK(ConvolutionalCode{CodeRate::kTwoThirds}.encode(impulse) ==
        std::vector<Bit>{1, 1, 0, 1, 1, 1, 0, 0, 1, 1, 1});
  CHECK(ConvolutionalCode{CodeRate::kThreeQuarters}.encode(impulse) ==
        std::vector<Bit>{1, 1, 0, 1, 1, 1, 0, 0, 1, 1});
}

TEST_CASE("what was coded is decoded, at every rate and length") {
  const auto rate = GENERATE(CodeRate::kHalf, CodeRate::kTwoThirds, CodeRate::kThreeQuarters);
  const ConvolutionalCode code{rate};
  for (const std::size_t bits : {1UL, 7UL, 100UL, 1001UL, 20'000UL}) {
    const std::vector<Bit> frame = frame_of(bits, bits);
    const std::vector<Bit> coded = code.encode(frame);

    CHECK(coded.size() == code.coded_bits(frame.size()));
    CHECK(code.decode(certain(coded), frame.size()) == frame);
  }
}

TEST_CASE("as many wrong bits as the free distance allows are put right, one more is not always") {
  // Free distances 10, 6 and 5 [Proakis, "Digital Communications", table 8.2.1, and Haccoun and
  // Begin, 1989]: (d - 1) / 2 errors never matter.
  const auto [rate, correctable] = GENERATE(table<CodeRate, std::size_t>(
      {{CodeRate::kHalf, 4}, {CodeRate::kTwoThirds, 2}, {CodeRate::kThreeQuarters, 2}}));
  const ConvolutionalCode code{rate};
  const std::vector<Bit> frame = frame_of(5, 30);
  const std::vector<Bit> coded = code.encode(frame);
  const random::CounterStream draws{6, 0};
  std::uint64_t draw = 0;
  const auto flipped = [&](std::size_t errors) {
    // Close together, where they hurt.
    std::vector<Bit> wrong = coded;
    const std::uint32_t first = draws.below(draw++, static_cast<std::uint32_t>(coded.size() - 12));
    for (std::size_t done = 0; done < errors;) {
      const std::size_t place = first + draws.below(draw++, 12);
      if (wrong[place] == coded[place]) {
        wrong[place] ^= 1U;
        ++done;
      }
    }
    return wrong;
  };
  bool beyond = true;
  for (int trial = 0; trial < 3000; ++trial) {
    REQUIRE(code.decode(certain(flipped(correctable)), frame.size()) == frame);
    beyond &= code.decode(certain(flipped(correctable + 2)), frame.size()) == frame;
  }
  CHECK_FALSE(beyond);
}

TEST_CASE("a rate without a code is refused") {
  CHECK_THROWS_WITH(ConvolutionalCode{CodeRate::kUncoded},
                    "convolutional code: the rate must be 1/2, 2/3 or 3/4");
}

}  // namespace
}  // namespace cuscus::netsim
