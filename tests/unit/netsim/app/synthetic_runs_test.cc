#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "common/city/transfer/city_message.h"
#include "netsim/app/synthetic_configuration.h"
#include "netsim/app/synthetic_table.h"

namespace cuscus::netsim {
namespace {

/// Two nodes 10 m apart at 54 Mb/s in free space.
proto::SyntheticRun pair(const std::string& traffic) {
  proto::SyntheticRun run;
  proto::RadioConfiguration& radio = *run.mutable_radio();
  radio.set_seed(3);
  radio.set_standard("802.11g");
  radio.set_data_rate_kbps(54'000);
  radio.set_group_rate_kbps(54'000);
  radio.add_basic_rates_kbps(24'000);
  radio.set_rate_control("constant");
  radio.set_carrier_hz(2.437e9);
  radio.set_noise_figure_db(7.0);
  radio.set_retry_limit(7);
  radio.set_long_retry_limit(7);
  radio.set_rts_threshold_bytes(0xffff'ffff);
  radio.set_queue_frames(500);
  radio.set_queue_lifetime_ns(500'000'000);
  radio.set_mac("dcf");
  radio.set_error_model("nist");
  radio.set_cca_preamble_dbm(-82.0);
  radio.set_cca_energy_dbm(-62.0);
  radio.set_detection_minimum_dbm(-82.0);
  radio.set_detection_minimum_sinr_db(4.0);
  radio.set_capture_in_preamble_db(std::numeric_limits<double>::infinity());
  radio.set_capture_in_frame_db(std::numeric_limits<double>::infinity());
  radio.mutable_propagation()->set_model("friis");
  radio.mutable_propagation()->set_fading("none");
  for (std::uint32_t i = 0; i < 2; ++i) {
    proto::RadioNode& node = *radio.add_nodes();
    node.set_node(i);
    node.set_mac("abcdef");
    node.set_tx_power_dbm(16.0);
    run.add_nodes()->mutable_p_wb_m()->set_x(10.0 * i);
  }
  run.mutable_traffic()->set_kind(traffic);
  run.mutable_traffic()->set_unicast(true);
  run.mutable_traffic()->set_udp_payload_bytes(1'472);
  run.mutable_traffic()->set_to(1);
  run.set_warm_up_ns(100'000'000);
  run.set_duration_ns(1'000'000'000);
  return run;
}

TEST_CASE("a run of a scenario's nodes becomes one with their radio and places") {
  proto::SyntheticRun run = pair("ping");
  run.mutable_traffic()->set_period_ns(20'000'000);
  run.mutable_nodes(1)->set_yaw_rad(1.0);

  const SyntheticParameters p = synthetic_parameters(run);

  CHECK(p.senders == 2);
  CHECK(p.air.seed == 3);
  CHECK(p.layout.kind == Layout::Kind::kGiven);
  CHECK(p.layout.p_WN_m[1].x() == 10.0);
  CHECK(p.layout.q_WN[1].angularDistance(p.layout.q_WN[0]) == Approx(1.0));
  CHECK(p.traffic.kind == Traffic::Kind::kPing);
  CHECK(p.traffic.period == std::chrono::milliseconds{20});
  CHECK(p.duration == std::chrono::seconds{1});
}

TEST_CASE("a flow without a period is as fast as one exchange after the other") {
  // DIFS + 7.5 slots + data + SIFS + ACK = 498 us: 24.096 Mb/s of IP [J. Jun et al., NCA 2003].
  const SyntheticResult result = run_synthetic(synthetic_parameters(pair("flow")));

  CHECK(result.goodput_mbps * 1'500 / 1'472 == Approx(24.096).epsilon(0.02));
  CHECK(result.jain == 1.0);
}

TEST_CASE("runs that make no sense are refused") {
  proto::SyntheticRun alone = pair("flow");
  alone.mutable_nodes()->RemoveLast();
  CHECK_THROWS_AS(synthetic_parameters(alone), std::invalid_argument);
  CHECK_THROWS_WITH(synthetic_parameters(pair("flood")),
                    "traffic 'flood' is unknown; allowed: beacons, saturated, flow, ping");
  proto::SyntheticRun itself = pair("flow");
  itself.mutable_traffic()->set_to(0);
  CHECK_THROWS_AS(synthetic_parameters(itself), std::invalid_argument);
}

TEST_CASE("a table of runs has a header and a line per run, and nothing when the first fails") {
  proto::SyntheticRuns runs;
  runs.set_scenario_name("pair");
  *runs.add_runs() = pair("flow");
  *runs.add_runs() = pair("saturated");
  std::ostringstream out;

  print_runs(runs, [&]() -> std::ostream& { return out; });

  std::istringstream lines{out.str()};
  std::string header;
  std::string first;
  std::string second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  CHECK(header.starts_with("scenario,traffic,cast,nodes,payload_B,seed,measure_s,goodput_mbps,"));
  CHECK(first.starts_with("pair,flow,ucast,2,1472,3,1.000,2"));
  CHECK(second.starts_with("pair,saturated,ucast,2,1472,3,1.000,2"));
  CHECK(std::count(first.begin(), first.end(), ',') ==
        std::count(header.begin(), header.end(), ','));

  runs.mutable_runs(0)->mutable_radio()->set_standard("802.11x");
  CHECK_THROWS_AS(
      print_runs(runs, []() -> std::ostream& { throw std::logic_error{"the table was begun"}; }),
      std::invalid_argument);
}

TEST_CASE("on a city's terrain the nodes' heights count from the ground beneath them") {
  const float height_m = GENERATE(0.0F, 5000.0F);
  city::City cliff;
  cliff.terrain = city::Terrain{.south_west_m = {0.0, 0.0},
                                .cell_m = 10.0,
                                .columns = 2,
                                .rows = 1,
                                .height_m = {0.0F, height_m}};
  proto::SyntheticRuns runs;
  runs.set_scenario_name("cliff");
  *runs.add_runs() = pair("flow");
  runs.set_city(city::to_message(cliff).SerializeAsString());
  std::ostringstream out;

  print_runs(runs, [&]() -> std::ostream& { return out; });

  // 16 dBm after 114 dB of 5 km of free space are far below what 54 Mb/s need.
  const bool heard = out.str().find(",1.000,0.0000,0.00000,") == std::string::npos;
  CHECK(heard == (height_m == 0.0F));
}

}  // namespace
}  // namespace cuscus::netsim
