#include "orchestrator/plan/capacity.h"

#include <catch2/catch.hpp>

#include "common/scenario/scenario_error.h"
#include "orchestrator/plan/plan.h"
#include "tests/unit/orchestrator/planned.h"

namespace cuscus::orchestrator {
namespace {

TEST_CASE("The estimate of an EDCA air has the AIFS of best effort and the longer header") {
  const auto busy = [](const std::string& radio) {
    return plan_of(R"({"name": "t", "fleet": [{"count": 10}], "radio": )" + radio + "}")
        .capacity.air_busy_fraction;
  };

  // 250 frames per second: AIFSN 3 is one slot of 20 us more than DIFS, and 2 B more take a symbol
  // of 4 us more: of 24 bits there are 22 + 8 * 144 or 146 in a beacon of 108 B of IP (49 and 50
  // symbols), 22 + 8 * 134 or 136 in a report of 98 B (46 and 47).
  CHECK(busy(R"({"mac": {"model": "edca"}})") - busy("{}") == Approx(250.0 * 24e-6));
}

TEST_CASE("The estimate of a TDMA air has neither backoff nor ACK") {
  const auto busy = [](const std::string& radio) {
    return plan_of(R"({"name": "t", "fleet": [{"count": 10}], "radio": )" + radio + "}")
        .capacity.air_busy_fraction;
  };

  // Per second and UAV 20 beacons and 5 reports: DIFS and 7.5 slots of 20 us each, and after a
  // report SIFS and an ACK of 50 us.
  CHECK(busy("{}") - busy(R"({"mac": {"model": "tdma"}})") ==
        Approx(250.0 * 200e-6 + 50.0 * 60e-6));
}

TEST_CASE("Time on air is the standard's") {
  // A 64 B IP packet is a PSDU of 100 B, a 1500 B one of 1536 B. IEEE Std 802.11-2020, 17.4.3:
  // 20 us + 4 us ceil((22 + 8 L) / N_DBPS), and 6 us signal extension (18.3.2.4).
  const scenario::Radio radio;
  CHECK(airtime_s(radio, 64, 6000) == Approx(166e-6));
  CHECK(airtime_s(radio, 64, 54000) == Approx(42e-6));
  CHECK(airtime_s(radio, 1500, 6000) == Approx(2078e-6));
  CHECK(airtime_s(radio, 1500, 54000) == Approx(254e-6));
  CHECK(airtime_s(radio, 64, 1000) == Approx(992e-6));  // 192 us + 800 bit
  // 802.11a has no extension; 802.11p is clocked at half: 40 + 8 ceil((22 + 8 L) / N_DBPS).
  CHECK(airtime_s(scenario::default_radio(scenario::RadioStandard::k80211a), 64, 6000) ==
        Approx(160e-6));
  CHECK(airtime_s(scenario::default_radio(scenario::RadioStandard::k80211p), 128, 3000) ==
        Approx(488e-6));
}

TEST_CASE("The estimate counts RTS and CTS before telemetry above the threshold") {
  const auto busy = [](const std::string& radio) {
    return plan_of(R"({"name": "t", "fleet": [{"count": 10}], "radio": )" + radio + "}")
        .capacity.air_busy_fraction;
  };

  // Five reports per second and UAV; RTS 58 us, CTS 50 us at 6 Mb/s, and two SIFS.
  CHECK(busy(R"({"rts_threshold": 0})") - busy("{}") == Approx(50.0 * (58.0 + 50.0 + 20.0) * 1e-6));
  CHECK(busy(R"({"rts_threshold": 1000})") == busy("{}"));
}

TEST_CASE("The estimate counts beacons at every receiver and telemetry at one") {
  const Plan plan = make_plan(scenario::load_scenario(kFolder / "default.json"));

  // 10 UAVs x 20 beacons/s + 10 x 5 reports/s; each beacon goes to 10 others.
  CHECK(plan.capacity.frames_per_s == Approx(250.0));
  CHECK(plan.capacity.copies_per_s == Approx(2050.0));
  CHECK(plan.capacity.air_busy_fraction > 0.05);
  CHECK(plan.capacity.air_busy_fraction < 0.15);
  CHECK(plan.capacity.warnings.empty());
}

TEST_CASE("A fleet that the host or the air cannot carry is warned about") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [{"count": 200,
      "neighbours": {"beacon_period": "10 ms"}}]})");

  REQUIRE(plan.capacity.warnings.size() == 2);
  CHECK_THAT(plan.capacity.warnings[0], Catch::Contains("keep the air busy"));
  CHECK_THAT(plan.capacity.warnings[1], Catch::Contains("the emulator needs about"));
  CHECK_THAT(to_text(plan), Catch::Contains("  warning  beacons and telemetry"));
}

}  // namespace
}  // namespace cuscus::orchestrator
