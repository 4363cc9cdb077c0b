// Saturated stations and hidden senders, every row of the references.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>

#include "netsim/app/synthetic.h"
#include "tests/validation/netsim/ns3_reference.h"

namespace cuscus::netsim {
namespace {

using std::chrono::seconds;

TEST_CASE("saturated stations share the air as in ns-3") {
  const std::string cast = GENERATE("ucast", "bcast");
  const auto rows =
      reference(cast == "ucast" ? "saturation_unicast.csv" : "saturation_broadcast.csv");
  int compared = 0;
  for (const CsvRow& row : rows) {
    SyntheticParameters p = with_rate(number(row, "mode_mbps"));
    p.layout = layout(row);
    p.air.slot = std::chrono::microseconds{static_cast<int>(number(row, "slot_us"))};
    p.senders = static_cast<std::uint32_t>(number(row, "n"));
    p.traffic = {.kind = Traffic::Kind::kSaturated,
                 .group = cast == "bcast",
                 .udp_payload_bytes = static_cast<std::uint32_t>(number(row, "payload_B"))};
    // As long as the reference's, which counts for the shares: they even out with time.
    p.duration = seconds{static_cast<int>(number(row, "measure_s"))};
    Sample goodput_mbps;
    Sample success;
    Sample repeated;
    Sample drops_ps;
    Sample jain;
    for (p.air.seed = 1; p.air.seed <= 5; ++p.air.seed) {
      const SyntheticResult r = run_synthetic(p);
      const Attempts attempts{r};
      goodput_mbps.add(r.goodput_mbps);
      success.add(cast == "bcast" ? r.delivery_ratio : r.attempt_success);
      repeated.add(attempts.repeated / attempts.all);
      drops_ps.add(r.drops_per_s);
      jain.add(r.jain);
    }

    CAPTURE(cast, row.at("layout"), row.at("slot_us"), row.at("mode_mbps"), row.at("n"),
            goodput_mbps.mean(), row.at("goodput_mbps_mean"), success.mean(),
            row.at("delivery_or_attempt_success_mean"), repeated.mean(), row.at("retry_frac_mean"),
            drops_ps.mean(), row.at("drops_per_s"), jain.mean(), row.at("jain_mean"));
    CHECK(agrees(goodput_mbps.mean(), number(row, "goodput_mbps_mean"),
                 std::hypot(goodput_mbps.ci95(), number(row, "goodput_ci95"))));
    CHECK(agrees(success.mean(), number(row, "delivery_or_attempt_success_mean"),
                 std::hypot(success.ci95(), number(row, "ci95"))));
    CHECK(agrees(1.0 - repeated.mean(), 1.0 - number(row, "retry_frac_mean"),
                 std::hypot(repeated.ci95(), number(row, "retry_ci95"))));
    CHECK(agrees(jain.mean(), number(row, "jain_mean"), 0.0));
    // Drops are rare and have no interval there: 2.6 deviations of the difference of two Poisson
    // counts, and one drop for a count of none.
    const double measured_s = 5.0 * number(row, "measure_s");
    CHECK(std::abs(drops_ps.mean() - number(row, "drops_per_s")) * measured_s <=
          1.0 + 2.6 * std::sqrt((drops_ps.mean() + number(row, "drops_per_s")) * measured_s));
    ++compared;
  }
  CHECK(compared == 30);  // all of them
}

TEST_CASE("hidden senders share a sink as in ns-3, with and without RTS") {
  // The reference's intervals are 1.96 standard errors of five seeds, in which one sender or the
  // other starves for seconds: Student's t asks for 2.78.
  constexpr double kStudent = 2.78 / 1.96;
  constexpr std::uint64_t kSeeds = 20;
  int compared = 0;
  for (const CsvRow& row : reference("hidden_terminal.csv")) {
    SyntheticParameters p = with_rate(number(row, "mode_mbps"));
    p.senders = 2;
    p.layout.kind =
        row.at("scenario") == "hidden" ? Layout::Kind::kHidden : Layout::Kind::kEqualPower;
    p.traffic = {.kind = Traffic::Kind::kSaturated,
                 .group = false,
                 .to_sink = true,
                 .udp_payload_bytes = static_cast<std::uint32_t>(number(row, "payload_B"))};
    if (row.at("rts") == "1") {
      p.air.rts_threshold_bytes = 0;
    }
    p.duration = seconds{8};
    Sample goodput_mbps;
    Sample one_mbps;
    Sample other_mbps;
    Sample drops_ps;
    Sample success;
    Sample repeated;
    for (p.air.seed = 1; p.air.seed <= kSeeds; ++p.air.seed) {
      const SyntheticResult r = run_synthetic(p);
      const Attempts attempts{r};
      goodput_mbps.add(r.goodput_mbps);
      one_mbps.add(r.sender_goodputs_mbps.at(0));
      other_mbps.add(r.sender_goodputs_mbps.at(1));
      drops_ps.add(r.drops_per_s);
      success.add(attempts.acknowledged / attempts.all);
      repeated.add(attempts.repeated / attempts.all);
    }

    CAPTURE(row.at("scenario"), row.at("payload_B"), row.at("rts"), goodput_mbps.mean(),
            row.at("total_mbps"), one_mbps.mean(), row.at("goodA_mbps"), other_mbps.mean(),
            row.at("goodC_mbps"), drops_ps.mean(), row.at("mpdu_drops_per_s"), success.mean(),
            row.at("data_attempt_success"), repeated.mean(), row.at("retry_frac"));
    CHECK(agrees(goodput_mbps.mean(), number(row, "total_mbps"),
                 std::hypot(goodput_mbps.ci95(), kStudent * number(row, "total_ci95"))));
    CHECK(agrees(one_mbps.mean(), number(row, "goodA_mbps"),
                 std::hypot(one_mbps.ci95(), kStudent * number(row, "goodA_ci95"))));
    CHECK(agrees(other_mbps.mean(), number(row, "goodC_mbps"),
                 // It has no interval there: it is the total less that of A.
                 std::hypot(other_mbps.ci95(),
                            kStudent * (number(row, "goodA_ci95") + number(row, "total_ci95")))));
    const double success_ci95 = std::hypot(success.ci95(), kStudent * number(row, "ci95"));
    CHECK(agrees(success.mean(), number(row, "data_attempt_success"), success_ci95));
    CHECK(agrees(1.0 - repeated.mean(), 1.0 - number(row, "retry_frac"), success_ci95));
    // With RTS ours are frames given up after seven RTS without CTS (0.9 to 2.5 a second), which
    // the reference does not count as drops of MPDUs.
    if (row.at("rts") == "0") {
      const double measured_s = 5.0 * 8.0;
      CHECK(std::abs(drops_ps.mean() - number(row, "mpdu_drops_per_s")) * measured_s <=
            2.6 * std::sqrt(number(row, "mpdu_drops_per_s") * measured_s));
    }
    ++compared;
  }
  CHECK(compared == 12);  // all of them
}

TEST_CASE("hidden broadcasters whose frames are longer than any gap deliver nothing at all") {
  SyntheticParameters p = with_rate(6.0);
  p.senders = 2;
  p.layout.kind = Layout::Kind::kHidden;
  // DIFS and 15 slots are 350 us; 1400 B last 1982 us.
  p.traffic = {.kind = Traffic::Kind::kSaturated, .to_sink = true, .udp_payload_bytes = 1400};
  CHECK(run_synthetic(p).receptions == 0);

  p.traffic.udp_payload_bytes = 64;  // 198 us of energy: gaps are found
  CHECK(run_synthetic(p).receptions > 0);
}

}  // namespace
}  // namespace cuscus::netsim
