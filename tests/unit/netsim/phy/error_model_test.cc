#include "netsim/phy/error_model.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "common/units/decibel.h"

namespace cuscus::netsim {
namespace {

double packet_error_rate(std::uint32_t rate_kbps, double snr_db, double bytes) {
  const Mode& mode = ieee80211g().mode(rate_kbps);
  const NistErrorModel nist;
  return 1.0 - std::exp(log_success(
                   nist.bit_failure(mode.modulation, mode.code_rate, Decibel{snr_db}.ratio()),
                   8.0 * bytes));
}

/// SNR at which the packet error rate is 10 %, by bisection.
double snr_at_ten_percent(std::uint32_t rate_kbps, double bytes) {
  double low_db = -5.0;
  double high_db = 40.0;
  while (high_db - low_db > 1e-6) {
    const double middle_db = 0.5 * (low_db + high_db);
    (packet_error_rate(rate_kbps, middle_db, bytes) > 0.1 ? low_db : high_db) = middle_db;
  }
  return low_db;
}

TEST_CASE("NIST packet error rates reach 10 % at the published signal to noise ratios") {
  // Computed independently of this code; rounded to 0.01 dB.
  const std::map<std::uint32_t, std::pair<double, double>> expected_db{
      {6'000, {3.85, 3.95}},    {9'000, {6.73, 6.85}},    {12'000, {6.86, 6.96}},
      {18'000, {9.74, 9.86}},   {24'000, {13.38, 13.50}}, {36'000, {16.48, 16.60}},
      {48'000, {21.23, 21.35}}, {54'000, {22.49, 22.61}}};
  for (const auto& [rate_kbps, snr_db] : expected_db) {
    CAPTURE(rate_kbps);
    CHECK(snr_at_ten_percent(rate_kbps, 1000) == Approx(snr_db.first).margin(0.0075));
    CHECK(snr_at_ten_percent(rate_kbps, 1458) == Approx(snr_db.second).margin(0.0075));
  }
}

TEST_CASE("NIST packet error rates of 1000 B agree with independent values") {
  CHECK(packet_error_rate(6'000, 3.0, 1000) == Approx(0.858).margin(0.001));
  CHECK(packet_error_rate(6'000, 4.0, 1000) == Approx(0.0591).margin(0.0001));
  CHECK(packet_error_rate(6'000, 5.0, 1000) == Approx(1.25e-3).margin(0.01e-3));
  CHECK(packet_error_rate(18'000, 10.0, 1000) == Approx(0.0433).margin(0.0001));
  CHECK(packet_error_rate(54'000, 22.0, 1000) == Approx(0.359).margin(0.001));
}

TEST_CASE("the bit weights of rate 1/2 are those of the code's own trellis") {
  // c_d of the code with generators 133 and 171 (octal), by counting input bits over all paths that
  // leave the zero state once and return: dynamic programming over (state, weight).
  constexpr std::size_t kStates = 64;
  constexpr std::size_t kWeights = 17;
  constexpr unsigned kFirst = 0133;
  constexpr unsigned kSecond = 0171;
  using Table = std::array<std::array<double, kWeights>, kStates>;
  Table paths{};
  Table bits{};
  std::array<double, kWeights> spectrum{};
  const auto parity = [](unsigned x) {
    return static_cast<std::size_t>(__builtin_popcount(x) % 2);
  };
  const auto extend = [&](const Table& p, const Table& b, unsigned state, unsigned input,
                          Table& next_p, Table& next_b) {
    const unsigned window = (input << 6U) | state;
    const std::size_t weight = parity(window & kFirst) + parity(window & kSecond);
    const unsigned next = window >> 1U;
    for (std::size_t w = 0; w + weight < kWeights; ++w) {
      next_p[next][w + weight] += p[state][w];
      next_b[next][w + weight] += b[state][w] + input * p[state][w];
    }
  };
  Table start_p{};
  start_p[0][0] = 1.0;
  extend(start_p, Table{}, 0, 1, paths, bits);
  for (int step = 0; step < 200; ++step) {
    Table next_p{};
    Table next_b{};
    for (unsigned state = 1; state < kStates; ++state) {
      extend(paths, bits, state, 0, next_p, next_b);
      extend(paths, bits, state, 1, next_p, next_b);
    }
    for (std::size_t w = 0; w < kWeights; ++w) {
      spectrum[w] += next_b[0][w];
      next_p[0][w] = next_b[0][w] = 0.0;
    }
    paths = next_p;
    bits = next_b;
  }

  CHECK(spectrum[10] == 36.0);
  CHECK(spectrum[11] == 0.0);
  CHECK(spectrum[12] == 211.0);
  CHECK(spectrum[14] == 1404.0);
  CHECK(spectrum[16] == 11633.0);
  // And the model uses them: at small D the first term is all there is.
  const NistErrorModel nist;
  const double sinr = Decibel{9.0}.ratio();
  const double p = 0.5 * std::erfc(std::sqrt(sinr));
  const double d2 = 4.0 * p * (1.0 - p);
  CHECK(nist.bit_failure(Modulation::kBpsk, CodeRate::kHalf, sinr) ==
        Approx(0.5 * spectrum[10] * std::pow(d2, 5)).epsilon(0.01));
}

TEST_CASE("an unknown error model is refused with what exists") {
  CHECK_THROWS_WITH(make_error_model("gut-feeling"),
                    "error model 'gut-feeling' is not known; allowed is 'nist'");
}

}  // namespace
}  // namespace cuscus::netsim
