#include "netsim/phy/error_model.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "common/units/decibel.h"

namespace cuscus::netsim {
namespace {

double packet_error_rate(const ErrorModel& model, std::uint32_t rate_kbps, double snr_db,
                         double bytes) {
  const Mode& mode = ieee80211g().mode(rate_kbps);
  return 1.0 - std::exp(log_success(
                   model.bit_failure(mode.modulation, mode.code_rate, Decibel{snr_db}.ratio()),
                   8.0 * bytes));
}

/// SNR at which the packet error rate is 10 %, by bisection.
double snr_at_ten_percent(const ErrorModel& model, std::uint32_t rate_kbps, double bytes) {
  double low_db = -5.0;
  double high_db = 40.0;
  while (high_db - low_db > 1e-6) {
    const double middle_db = 0.5 * (low_db + high_db);
    (packet_error_rate(model, rate_kbps, middle_db, bytes) > 0.1 ? low_db : high_db) = middle_db;
  }
  return low_db;
}

TEST_CASE("NIST packet error rates reach 10 % at the published signal to noise ratios") {
  // Computed independently of this code; rounded to 0.01 dB.
  const std::map<std::uint32_t, std::pair<double, double>> expected_db{
      {6'000, {3.85, 3.95}},    {9'000, {6.73, 6.85}},    {12'000, {6.86, 6.96}},
      {18'000, {9.74, 9.86}},   {24'000, {13.38, 13.50}}, {36'000, {16.48, 16.60}},
      {48'000, {21.23, 21.35}}, {54'000, {22.49, 22.61}}};
  const NistErrorModel nist;
  for (const auto& [rate_kbps, snr_db] : expected_db) {
    CAPTURE(rate_kbps);
    CHECK(snr_at_ten_percent(nist, rate_kbps, 1000) == Approx(snr_db.first).margin(0.0075));
    CHECK(snr_at_ten_percent(nist, rate_kbps, 1458) == Approx(snr_db.second).margin(0.0075));
  }
}

TEST_CASE("NIST packet error rates of 1000 B agree with independent values") {
  const NistErrorModel nist;
  CHECK(packet_error_rate(nist, 6'000, 3.0, 1000) == Approx(0.858).margin(0.001));
  CHECK(packet_error_rate(nist, 6'000, 4.0, 1000) == Approx(0.0591).margin(0.0001));
  CHECK(packet_error_rate(nist, 6'000, 5.0, 1000) == Approx(1.25e-3).margin(0.01e-3));
  CHECK(packet_error_rate(nist, 18'000, 10.0, 1000) == Approx(0.0433).margin(0.0001));
  CHECK(packet_error_rate(nist, 54'000, 22.0, 1000) == Approx(0.359).margin(0.001));
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

TEST_CASE("YANS packet error rates reach 10 % at the published signal to noise ratios") {
  // 1458 B; computed independently of this code, rounded to 0.01 dB.
  const std::map<std::uint32_t, double> expected_db{
      {6'000, 0.74},   {9'000, 3.03},   {12'000, 3.73},  {18'000, 6.61},
      {24'000, 10.12}, {36'000, 13.29}, {48'000, 17.75}, {54'000, 19.24}};
  const YansErrorModel yans;
  for (const auto& [rate_kbps, snr_db] : expected_db) {
    CAPTURE(rate_kbps);
    CHECK(snr_at_ten_percent(yans, rate_kbps, 1458) == Approx(snr_db).margin(0.0075));
  }
}

TEST_CASE("DSSS and CCK need the bit energies that theory gives") {
  // E_b/N_0 for a bit error rate of 10^-5: DBPSK 10.34 dB (½ e^-x); DQPSK 2.33 dB above coherent
  // QPSK's 9.59 dB [Proakis, figure 5.2-17: about 2.3 dB].
  const auto error_at = [](Modulation modulation, double rate_Mbps, double bit_snr_db) {
    return dsss_bit_failure(modulation, Decibel{bit_snr_db}.ratio() * rate_Mbps / 20.0);
  };
  CHECK(error_at(Modulation::kDbpsk, 1.0, 10.342) == Approx(1e-5).epsilon(0.01));
  CHECK(error_at(Modulation::kDqpsk, 2.0, 11.9) == Approx(1e-5).epsilon(0.3));
  CHECK(error_at(Modulation::kDqpsk, 2.0, -20.0) == Approx(0.5).margin(0.1));
  // CCK at high SNR: the nearest code words alone. 5.5 Mb/s: 14 of 15 others at distance² 16;
  // 11 Mb/s: 24 of 255 at distance² 8. Q(√(d² E_c / 2N_0)), spread over the bits of a word.
  const double sinr = Decibel{8.0}.ratio();
  const auto pairwise = [&](double squared) {
    return 0.5 * std::erfc(std::sqrt(squared * sinr * 20.0 / 11.0 / 4.0));
  };
  CHECK(dsss_bit_failure(Modulation::kCck4Bit, sinr) == Approx(14.0 * pairwise(16.0) / 4.0));
  CHECK(dsss_bit_failure(Modulation::kCck8Bit, sinr) ==
        Approx(24.0 * pairwise(8.0) / 8.0).epsilon(0.05));
}

TEST_CASE("every error model is monotone and ends at 0 and 1 or one half") {
  const auto* const name = GENERATE("nist", "yans", "table");
  const auto model = make_error_model(name);
  for (const Mode& mode : ieee80211g().modes) {
    CAPTURE(name, mode.rate_kbps);
    double previous = 1.0;
    for (double snr_db = -30.0; snr_db < 60.0; snr_db += 0.5) {
      const double p = model->bit_failure(mode.modulation, mode.code_rate, Decibel{snr_db}.ratio());
      REQUIRE(p <= previous * (1.0 + 1e-12));
      REQUIRE(p >= 0.0);
      previous = p;
    }
    CHECK(model->bit_failure(mode.modulation, mode.code_rate, 0.0) >= 0.25);
    CHECK(previous < 1e-30);
  }
}

TEST_CASE("an unknown error model is refused with what exists") {
  CHECK_THROWS_WITH(make_error_model("gut-feeling"),
                    "error model 'gut-feeling' is not known; allowed are 'nist', 'yans', 'table'");
}

}  // namespace
}  // namespace cuscus::netsim
