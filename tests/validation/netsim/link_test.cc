// The table of error rates against the link that it was sampled from, and against published rates.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "netsim/link/link_curve.h"
#include "netsim/phy/link_error_model.h"

namespace cuscus::netsim {
namespace {

double frame_loss(const Mode& mode, double snr_db, double bits) {
  const LinkErrorModel model;
  return -std::expm1(log_success(
      model.bit_failure(mode.modulation, mode.code_rate, Decibel{snr_db}.ratio()), bits));
}

double snr_db_at(const Mode& mode, double loss, double bits) {
  double low_db = -10.0;
  double high_db = 40.0;
  while (high_db - low_db > 1e-6) {
    const double middle_db = 0.5 * (low_db + high_db);
    (frame_loss(mode, middle_db, bits) > loss ? low_db : high_db) = middle_db;
  }
  return low_db;
}

TEST_CASE("frames of other lengths and SNRs than those sampled are lost as the table has it") {
  // Bracketed by the table at 0.2 dB more and 0.2 dB less, widened by three standard deviations.
  constexpr double kTolerance_db = 0.2;
  constexpr std::uint64_t kFrames = 1500;
  for (const Mode& mode : standard_of("802.11a").modes) {
    const OfdmLink link{mode.modulation, mode.code_rate, 99};
    for (const std::uint64_t bytes : {60U, 400U}) {
      const std::uint64_t bits = 16 + 8 * bytes;
      const double snr_db = snr_db_at(mode, 0.25, static_cast<double>(bits));
      const LinkPoint point =
          sample_link(link, snr_db, bits, {.failures = kFrames, .frames = kFrames});
      const double lost = static_cast<double>(point.failures) / static_cast<double>(kFrames);
      const double noise = 3.0 * std::sqrt(0.25 * 0.75 / static_cast<double>(kFrames));
      const auto n = static_cast<double>(bits);
      CAPTURE(mode.rate_kbps, bytes, snr_db, lost);
      CHECK(lost < frame_loss(mode, snr_db - kTolerance_db, n) + noise);
      CHECK(lost > frame_loss(mode, snr_db + kTolerance_db, n) - noise);
    }
  }
}

TEST_CASE("the rates need the SNRs that another link simulation found") {
  // SNR [dB] at which 10 % of frames of 1458 B and of 32 B are lost, read from the curves of the
  // table-based error model of ns-3. Its receiver is not ours: 0.6 dB are allowed.
  struct Row {
    std::uint32_t rate_kbps;
    double long_db;
    double short_db;
  };
  constexpr std::array kRows{Row{6'000, 0.92, -0.36},   Row{12'000, 3.94, 2.61},
                             Row{18'000, 6.43, 5.10},   Row{24'000, 9.70, 8.06},
                             Row{36'000, 12.80, 11.28}, Row{48'000, 17.04, 15.31},
                             Row{54'000, 18.38, 16.61}};
  for (const Row& row : kRows) {
    const Mode& mode = standard_of("802.11a").mode(row.rate_kbps);
    CAPTURE(row.rate_kbps, snr_db_at(mode, 0.1, 8 * 1458), snr_db_at(mode, 0.1, 8 * 32));
    CHECK(snr_db_at(mode, 0.1, 8 * 1458) == Approx(row.long_db).margin(0.6));
    CHECK(snr_db_at(mode, 0.1, 8 * 32) == Approx(row.short_db).margin(0.6));
  }
}

TEST_CASE("a curve falls from nearly all lost to nearly none") {
  const LinkSampling quick{.step_db = 1.0, .failures = 30, .frames = 400, .least_failures = 5};

  const auto curve = link_curve(Modulation::k64Qam, CodeRate::kThreeQuarters, quick);

  REQUIRE(curve.size() >= 3);
  CHECK(curve.front().frame_bits == kShortFrameBits);
  CHECK(curve.back().frame_bits == kLongFrameBits);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    CHECK(curve[i].bit_failure() < curve[i - 1].bit_failure());
  }
}

}  // namespace
}  // namespace cuscus::netsim
