#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "orchestrator/plan/plan.h"
#include "tests/unit/orchestrator/planned.h"

namespace cuscus::orchestrator {
namespace {

TEST_CASE("Each propagation model reaches the radio with its parameters") {
  const Plan paper = plan_of(R"({"name": "t", "fleet": [{}], "radio": {"propagation":
      {"model": "paper-eq1", "alpha": 22, "chi": "9 dB2"}, "preamble_detection": "none"}})");
  CHECK(paper.radio.propagation().alpha() == 22.0);
  CHECK(paper.radio.propagation().chi_db2() == 9.0);
  CHECK(paper.radio.detection_minimum_dbm() == -HUGE_VAL);

  const Plan distance = plan_of(R"({"name": "t", "fleet": [{}], "radio": {"propagation":
      {"model": "log-distance", "exponent": 2.7}}})");
  CHECK(distance.radio.propagation().exponent() == 2.7);
  CHECK(distance.radio.propagation().reference_loss_db() == 0.0);
}

TEST_CASE("Fading, shadowing and RTS reach the radio's configuration") {
  const auto radio_of = [](const std::string& radio) {
    return plan_of(R"({"name": "t", "fleet": [{}], "radio": )" + radio + "}").radio;
  };

  const auto rice = radio_of(R"({"rts_threshold": 0, "shadowing": {"deviation": "5 dB"},
                                 "fading": {"model": "rice", "k_factor": "4 dB"}})");
  CHECK(rice.rts_threshold_bytes() == 0);
  CHECK(rice.propagation().shadowing_db() == 5.0);
  CHECK(rice.propagation().shadowing_decorrelation_m() == 20.0);
  CHECK(rice.propagation().fading() == "rice");
  CHECK(rice.propagation().k_factor_db() == 4.0);
  CHECK(rice.propagation().k_factor_overhead_db() == 15.0);
  const auto rayleigh = radio_of(R"({"fading": {"model": "rayleigh"}, "preamble": "short",
                                     "control_answer": "any-class"})");
  CHECK(rayleigh.propagation().fading() == "rice");
  CHECK(std::isinf(rayleigh.propagation().k_factor_db()));
  CHECK(std::isinf(rayleigh.propagation().k_factor_overhead_db()));
  CHECK(rayleigh.short_preamble());
  CHECK(rayleigh.answer_in_any_class());
  CHECK(radio_of(R"({"fading": {"model": "nakagami", "m": 3.5}})").propagation().nakagami_m() ==
        3.5);
}

TEST_CASE("Slots go to nodes by number, and to nobody where they have no owner") {
  const auto radio_of = [](const std::string& mac) {
    return plan_of(R"({"name": "t", "fleet": [{"count": 2}], "radio": {"mac": )" + mac + "}}")
        .radio;
  };

  const proto::RadioConfiguration named =
      radio_of(R"({"model": "tdma", "slot": "3 ms", "frame": ["gcs", "-", "uav1"]})");
  CHECK(named.mac() == "tdma");
  CHECK(named.tdma().slot_ns() == 3'000'000);
  CHECK(named.tdma().guard_ns() == 10'000);
  REQUIRE(named.tdma().frame_size() == 3);
  CHECK(named.tdma().frame(0) == 2);
  CHECK(named.tdma().frame(1) == -2);
  CHECK(named.tdma().frame(2) == 1);
  CHECK(radio_of(R"({"model": "tdma"})").tdma().frame_size() == 0);
  CHECK(radio_of(R"({"model": "dcf"})").mac() == "dcf");
  CHECK_FALSE(radio_of(R"({"model": "dcf"})").has_tdma());
}

TEST_CASE("EDCA's categories reach the radio in order, with the standard's values by default") {
  const auto edca_of = [](const std::string& radio) {
    return plan_of(R"({"name": "t", "fleet": [{}], "radio": )" + radio + "}").radio;
  };
  const auto text = [](const proto::EdcaCategory& category) {
    return std::to_string(category.aifsn()) + '/' + std::to_string(category.cw_min()) + '/' +
           std::to_string(category.cw_max());
  };

  const proto::RadioConfiguration vehicular =
      edca_of(R"({"standard": "802.11p", "mac": {"model": "edca", "voice": {"aifsn": 5}}})");
  CHECK(vehicular.mac() == "edca");
  REQUIRE(vehicular.edca().categories_size() == 4);
  CHECK(text(vehicular.edca().categories(0)) == "9/15/1023");
  CHECK(text(vehicular.edca().categories(1)) == "6/15/1023");
  CHECK(text(vehicular.edca().categories(2)) == "3/7/15");
  CHECK(text(vehicular.edca().categories(3)) == "5/3/7");
  const proto::RadioConfiguration dsss =
      edca_of(R"({"standard": "802.11b", "mac": {"model": "edca"}})");
  CHECK(text(dsss.edca().categories(0)) == "7/31/1023");
  CHECK(text(dsss.edca().categories(1)) == "3/31/1023");
  CHECK(text(dsss.edca().categories(2)) == "2/15/31");
  CHECK(text(dsss.edca().categories(3)) == "2/7/15");
  CHECK_FALSE(edca_of("{}").has_edca());
}

TEST_CASE("An ideal air reaches the radio's configuration") {
  const auto ideal_of = [](const std::string& mac) {
    return plan_of(R"({"name": "t", "fleet": [{}], "radio": {"mac": )" + mac + "}}").radio;
  };

  const proto::RadioConfiguration radio = ideal_of(
      R"({"model": "ideal", "delay": "2 ms", "jitter": "1 ms", "loss": 0.25, "range": "300 m"})");
  CHECK(radio.mac() == "ideal");
  CHECK(radio.ideal().delay_ns() == 2'000'000);
  CHECK(radio.ideal().jitter_ns() == 1'000'000);
  CHECK(radio.ideal().loss() == 0.25);
  CHECK(radio.ideal().range_m() == 300.0);
  CHECK(std::isinf(ideal_of(R"({"model": "ideal"})").ideal().range_m()));
}

TEST_CASE("An antenna reaches the radio's configuration") {
  const auto radio_of = [](const std::string& antenna) {
    return plan_of(R"({"name": "t", "fleet": [{}], "radio": {"antenna": )" + antenna + "}}").radio;
  };

  CHECK(radio_of("\"isotropic\"").antenna() == "isotropic");
  CHECK(radio_of("\"dipole\"").antenna() == "dipole");
  const auto pattern = radio_of(R"({"gains": [[1, 2, 3], [4, 5, 6.5]]})");
  CHECK(pattern.antenna() == "pattern");
  CHECK(pattern.antenna_pattern_azimuths() == 3);
  REQUIRE(pattern.antenna_pattern_dbi_size() == 6);
  CHECK(pattern.antenna_pattern_dbi(2) == 3.0);
  CHECK(pattern.antenna_pattern_dbi(5) == 6.5);
}

TEST_CASE("Obstacles and jammers reach the radio's configuration") {
  const auto radio = plan_of(R"({"name": "t", "fleet": [{}], "radio": {
      "propagation": {"model": "paper-eq1", "outer_wall": "15 dB", "inner_wall": "4 dB"},
      "obstacles": [{"name": "house", "centre": ["40 m", "-3 m"], "size": ["20 m", "10 m", "12 m"],
                     "heading": "90 deg", "outer_wall": "concrete",
                     "inner_walls": {"spacing": "4 m", "loss": "3 dB"}},
                    {"size": ["1 m", "1 m", "1 m"]}],
      "jammers": [{"name": "noise", "position": ["1 m", "2 m", "3 m"], "power": "33 dBm",
                   "bandwidth": "5 MHz", "duty": 0.2, "period": "3 ms", "start": "10 s",
                   "stop": "20 s"},
                  {"position": ["1 m", "2 m", "3 m"], "frequency": "2.44 GHz"}]}})")
                         .radio;

  CHECK(radio.propagation().outer_wall_db() == 15.0);
  CHECK(radio.propagation().inner_wall_db() == 4.0);
  REQUIRE(radio.obstacles_size() == 2);
  const auto& house = radio.obstacles(0);
  CHECK(house.name() == "house");
  CHECK(house.centre_x_m() == 40.0);
  CHECK(house.centre_y_m() == -3.0);
  CHECK(house.size_m().x() == 20.0);
  CHECK(house.size_m().y() == 10.0);
  CHECK(house.size_m().z() == 12.0);
  CHECK(house.heading_rad() == Approx(1.5707963));
  CHECK(house.outer_wall_db() == 15.0);
  CHECK(house.inner_spacing_m() == 4.0);
  CHECK(house.inner_wall_db() == 3.0);
  CHECK(radio.obstacles(1).outer_wall_db() == 12.0);
  CHECK(radio.obstacles(1).inner_spacing_m() == 0.0);
  REQUIRE(radio.jammers_size() == 2);
  const auto& noise = radio.jammers(0);
  CHECK(noise.name() == "noise");
  CHECK(noise.p_wj_m().y() == 2.0);
  CHECK(noise.power_dbm() == 33.0);
  CHECK(noise.frequency_hz() == 2.437e9);
  CHECK(noise.bandwidth_hz() == 5e6);
  CHECK(noise.duty() == 0.2);
  CHECK(noise.period_ns() == 3'000'000);
  CHECK(noise.start_ns() == 10'000'000'000);
  CHECK(noise.stop_ns() == 20'000'000'000);
  CHECK(radio.jammers(1).frequency_hz() == 2.44e9);
  CHECK(radio.jammers(1).stop_ns() == std::numeric_limits<std::int64_t>::max());
}

TEST_CASE("A disruption reaches the radio's configuration") {
  const auto radio_of = [](const std::string& disruption) {
    return plan_of(R"({"name": "t", "fleet": [{}], "radio": {"disruption": )" + disruption + "}}")
        .radio;
  };

  CHECK(radio_of("\"none\"").disruption_fraction() == 0.0);
  const auto fixed = radio_of(R"({"fraction": 0.7, "interval": "2 s", "phase": "500 ms"})");
  CHECK(fixed.disruption_fraction() == 0.7);
  CHECK(fixed.disruption_interval_ns() == 2'000'000'000);
  CHECK(fixed.disruption_offset_ns() == 500'000'000);
  CHECK_FALSE(fixed.disruption_at_random());
  CHECK(radio_of(R"({"phase": "random"})").disruption_at_random());
  CHECK(radio_of("{}").disruption_fraction() == 0.4);
}

}  // namespace
}  // namespace cuscus::orchestrator
