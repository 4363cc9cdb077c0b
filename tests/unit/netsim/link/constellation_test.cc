#include "netsim/link/constellation.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {
namespace {

constexpr std::array kOfdm{Modulation::kBpsk, Modulation::kQpsk, Modulation::k16Qam,
                           Modulation::k64Qam};

std::vector<std::complex<float>> mapped(const Constellation& constellation,
                                        const std::vector<Bit>& coded) {
  std::vector<std::complex<float>> points;
  constellation.map(coded, points);
  return points;
}

TEST_CASE("a symbol of random bits has mean power 1 and comes back as it was") {
  const auto modulation = GENERATE(from_range(kOfdm));
  const Constellation constellation{modulation};
  const random::CounterStream draws{3, 0};
  std::uint64_t draw = 0;
  double power = 0.0;
  constexpr int kSymbols = 200;
  for (int symbol = 0; symbol < kSymbols; ++symbol) {
    std::vector<Bit> coded(constellation.bits_per_symbol());
    for (Bit& bit : coded) {
      bit = static_cast<Bit>(draws.below(draw++, 2));
    }
    const auto points = mapped(constellation, coded);
    for (const auto& point : points) {
      power += std::norm(point);
    }
    std::vector<float> metrics;
    constellation.demap(points, std::vector<float>(kDataSubcarriers, 1.0F), metrics);
    REQUIRE(metrics.size() == coded.size());
    for (std::size_t k = 0; k < coded.size(); ++k) {
      REQUIRE((metrics[k] > 0.0F) == (coded[k] != 0));
    }
  }
  // The standard deviation of the mean of 9600 points is below 0.7 %.
  CHECK(power / (kSymbols * static_cast<double>(kDataSubcarriers)) == Approx(1.0).epsilon(0.03));
}

TEST_CASE("coded bits are spread over the subcarriers as the standard has it") {
  // Single bits, and on which subcarrier they change the point [17.3.5.7, by hand]: neighbours are
  // three subcarriers apart. Bit 1 of 16-QAM: i = 12, j = 2 * 6 + (12 + 192 - 1) mod 2 = 13, which
  // is bit 1 of subcarrier 3; bit 16: i = 1, j = (1 + 192) mod 2 = 1, bit 1 of subcarrier 0.
  const auto [modulation, bit, subcarrier] =
      GENERATE(table<Modulation, std::size_t, std::size_t>({{Modulation::kBpsk, 1, 3},
                                                            {Modulation::kBpsk, 16, 1},
                                                            {Modulation::kQpsk, 1, 3},
                                                            {Modulation::kQpsk, 17, 3},
                                                            {Modulation::k16Qam, 1, 3},
                                                            {Modulation::k16Qam, 16, 0},
                                                            {Modulation::k64Qam, 1, 3},
                                                            {Modulation::k64Qam, 96, 1}}));
  const Constellation constellation{modulation};
  std::vector<Bit> coded(constellation.bits_per_symbol(), 0);
  const auto before = mapped(constellation, coded);
  coded[bit] = 1;
  const auto after = mapped(constellation, coded);

  std::set<std::size_t> changed;
  for (std::size_t c = 0; c < kDataSubcarriers; ++c) {
    if (before[c] != after[c]) {
      changed.insert(c);
    }
  }
  CHECK(changed == std::set{subcarrier});
}

TEST_CASE("bits are mapped to the levels of the standard's tables") {
  // The in-phase level of subcarrier 0 for the first axis's bits [tables 17-8 to 17-11], in units
  // of 1, 1/sqrt 2, 1/sqrt 10, 1/sqrt 42. The bits of subcarrier 0 are every 16th coded bit; those
  // of 64-QAM stay in place there, and those of 16-QAM too.
  struct Row {
    Modulation modulation;
    std::vector<Bit> bits;
    double level;
  };
  const auto row = GENERATE(Row{Modulation::kBpsk, {0}, -1.0}, Row{Modulation::kBpsk, {1}, 1.0},
                            Row{Modulation::kQpsk, {0}, -1.0 / std::sqrt(2.0)},
                            Row{Modulation::k16Qam, {0, 0}, -3.0 / std::sqrt(10.0)},
                            Row{Modulation::k16Qam, {0, 1}, -1.0 / std::sqrt(10.0)},
                            Row{Modulation::k16Qam, {1, 1}, 1.0 / std::sqrt(10.0)},
                            Row{Modulation::k16Qam, {1, 0}, 3.0 / std::sqrt(10.0)},
                            Row{Modulation::k64Qam, {0, 0, 0}, -7.0 / std::sqrt(42.0)},
                            Row{Modulation::k64Qam, {0, 1, 0}, -1.0 / std::sqrt(42.0)},
                            Row{Modulation::k64Qam, {1, 1, 1}, 3.0 / std::sqrt(42.0)},
                            Row{Modulation::k64Qam, {1, 0, 0}, 7.0 / std::sqrt(42.0)});
  const Constellation constellation{row.modulation};
  std::vector<Bit> coded(constellation.bits_per_symbol(), 0);
  for (std::size_t b = 0; b < row.bits.size(); ++b) {
    coded[16 * b] = row.bits[b];
  }

  CHECK(mapped(constellation, coded).front().real() == Approx(row.level));
}

TEST_CASE("a modulation that OFDM does not have is refused") {
  CHECK_THROWS_WITH(Constellation{Modulation::kDbpsk},
                    "constellation: the modulation must be OFDM's");
}

}  // namespace
}  // namespace cuscus::netsim
