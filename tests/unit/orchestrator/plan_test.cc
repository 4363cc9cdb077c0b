#include "orchestrator/plan/plan.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "common/scenario/scenario_error.h"
#include "orchestrator/plan/capacity.h"

namespace cuscus::orchestrator {
namespace {

const std::filesystem::path kFolder{CUSCUS_SCENARIO_FOLDER};

scenario::Scenario parse(const std::string& text) {
  return scenario::parse_scenario(text, "flight.json", "/scenarios");
}

Plan plan_of(const std::string& text) { return make_plan(parse(text)); }

TEST_CASE("The default scenario becomes ten UAVs and a ground station") {
  const Plan plan = make_plan(scenario::load_scenario(kFolder / "default.json"));

  REQUIRE(plan.nodes.size() == 11);
  std::set<std::string> ips;
  std::set<std::string> macs;
  for (std::uint32_t i = 0; i < 11; ++i) {
    const NodePlan& node = plan.nodes[i];
    CHECK(node.index == i);
    CHECK(node.ip == "10.42.0." + std::to_string(i + 1));
    CHECK((node.mac[0] & 0x03U) == 0x02U);  // locally administered, not a group address
    ips.insert(node.ip);
    macs.insert(mac_text(node.mac));
  }
  CHECK(ips.size() == 11);
  CHECK(macs.size() == 11);
  CHECK(plan.nodes[0].name == "uav0");
  CHECK(plan.nodes[9].name == "uav9");
  CHECK(plan.nodes[9].role == NodeRole::kUav);
  CHECK(plan.nodes[10].name == "gcs");
  CHECK(plan.nodes[10].role == NodeRole::kGroundStation);
  CHECK(mac_text(plan.nodes[0].mac) == "02:63:75:73:00:01");
  CHECK(plan.nodes[3].tap == "tap3");
  CHECK(plan.nodes[3].bridge == "br3");
  CHECK(plan.nodes[3].veth == "veth3");
  CHECK(plan.hosts.size() == 11);
  CHECK(plan.page_port == 8080);
  CHECK_FALSE(plan.motion_capture_memory);
}

TEST_CASE("Each component of the default scenario is told all that it needs") {
  const Plan plan = make_plan(scenario::load_scenario(kFolder / "default.json"));

  const proto::WorldConfiguration& world = plan.world;
  CHECK(world.step_ns() == 1'000'000);
  CHECK(world.imu_period_ns() == 5'000'000);
  CHECK(world.motion_capture_period_ns() == 10'000'000);
  CHECK(world.gravity_mps2() == 9.81);
  REQUIRE(world.nodes_size() == 11);
  CHECK(world.nodes(0).p_wb_start_m().x() == 20.0);
  CHECK(world.nodes(0).multirotor().mass_kg() == 1.2);
  CHECK(world.nodes(0).multirotor().motor_speed_per_command() == 86.0);
  CHECK(world.nodes(0).multirotor().source() == "FL-AIR, simulator_x4.xml");
  CHECK_FALSE(world.nodes(10).has_multirotor());
  CHECK(world.nodes(10).p_wb_start_m().z() == 1.0);

  const proto::RadioConfiguration& radio = plan.radio;
  CHECK(radio.standard() == "802.11g");
  CHECK(radio.data_rate_kbps() == 6000);
  CHECK(radio.basic_rates_kbps_size() == 3);
  CHECK(radio.carrier_hz() == 2.437e9);
  CHECK(radio.slot_ns() == 20'000);
  CHECK(radio.queue_lifetime_ns() == 500'000'000);
  CHECK(radio.detection_minimum_dbm() == -82.0);
  CHECK(radio.propagation().model() == "friis");
  CHECK(radio.propagation().fading() == "none");
  CHECK(radio.propagation().shadowing_db() == 0.0);
  CHECK(radio.rts_threshold_bytes() == 0xffffffff);
  CHECK(radio.long_retry_limit() == 7);
  CHECK(radio.bridge());
  REQUIRE(radio.nodes_size() == 11);
  CHECK(radio.nodes(4).mac() == std::string("\x02\x63\x75\x73\x00\x05", 6));
  CHECK(radio.nodes(4).tx_power_dbm() == 16.0);
  CHECK(radio.realtime_priority() > world.realtime_priority());

  const proto::AgentConfiguration& agent = plan.nodes[3].agent.value();
  CHECK(agent.node() == 3);
  CHECK(agent.slot() == 3);
  CHECK(agent.fleet_size() == 10);
  CHECK(agent.control_period_ns() == 5'000'000);
  CHECK(agent.circle().radius_m() == 20.0);
  CHECK(agent.circle().p_wc_centre_m().z() == 10.0);
  CHECK(agent.beacon_period_ns() == 50'000'000);
  CHECK(agent.beacon_address() == "10.42.255.255");
  CHECK(agent.beacon_port() == 47100);
  CHECK(agent.telemetry_address() == "10.42.0.11");
  CHECK(agent.telemetry_port() == 47000);
  CHECK(agent.slot_nodes_size() == 10);
  CHECK(agent.motion_capture_noise_m() == 0.0002);
  CHECK(agent.realtime_priority() < world.realtime_priority());

  const proto::GroundStationConfiguration& gcs = plan.ground_station.value();
  CHECK(gcs.node() == 10);
  CHECK(gcs.nodes_size() == 11);
  CHECK(gcs.nodes(0).is_vehicle());
  CHECK_FALSE(gcs.nodes(10).is_vehicle());
  CHECK(gcs.nodes(0).telemetry_period_ns() == 200'000'000);
  CHECK(gcs.nodes(10).telemetry_period_ns() == 0);
  CHECK(gcs.circle().radius_m() == 20.0);
  CHECK(gcs.duration_ns() == 60'000'000'000);
}

TEST_CASE("Two pings become two fixed nodes with a command each and nothing else") {
  const Plan plan = make_plan(scenario::load_scenario(kFolder / "two-pings.json"));

  REQUIRE(plan.nodes.size() == 2);
  CHECK_FALSE(plan.ground_station);
  CHECK_FALSE(plan.page_port);
  for (const NodePlan& node : plan.nodes) {
    CHECK(node.role == NodeRole::kFixed);
    CHECK_FALSE(node.agent);
    REQUIRE(node.programs.size() == 1);
    CHECK(node.programs[0].kind == ProgramKind::kCommand);
    CHECK(node.programs[0].capabilities == std::vector<std::string>{"cap_net_raw"});
    CHECK_FALSE(node.programs[0].has_control_socket);
  }
  CHECK(plan.nodes[0].programs[0].arguments.back() == "10.42.0.2");
  CHECK(plan.nodes[1].programs[0].arguments.back() == "10.42.0.1");
  CHECK(plan.nodes[0].programs[0].log_name == "left0-command.log");
  CHECK(std::hypot(plan.nodes[0].p_WB_start_m[0] - plan.nodes[1].p_WB_start_m[0],
                   plan.nodes[0].p_WB_start_m[1] - plan.nodes[1].p_WB_start_m[1]) == 100.0);
}

TEST_CASE("A command is given its own UAV's values, and its environment wins") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [
      {"name": "a", "count": 2, "command": ["./run", "{index}", "{name}", "{gcs_ip}"],
       "environment": {"LANG": "it_IT", "ME": "{ip}"}}]})");

  const NodePlan& node = plan.nodes.at(1);
  REQUIRE(node.programs.size() == 2);
  CHECK(node.programs[0].kind == ProgramKind::kAgent);
  CHECK(node.programs[0].has_control_socket);
  const Program& command = node.programs[1];
  CHECK(command.arguments == std::vector<std::string>{"/scenarios/run", "1", "a1", "10.42.0.3"});
  const std::set<std::string> environment(command.environment.begin(), command.environment.end());
  CHECK(environment.contains("LANG=it_IT"));
  CHECK_FALSE(environment.contains("LANG=C.UTF-8"));
  CHECK(environment.contains("ME=10.42.0.2"));
  CHECK(environment.contains("CUSCUS_NAME=a1"));
  CHECK(environment.contains("CUSCUS_GCS_IP=10.42.0.3"));
}

TEST_CASE("An agent of one's own takes the place of ours, with socket and configuration") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [
      {"name": "a", "count": 2, "agent": ["./fly", "{index}"], "environment": {"ME": "{ip}"},
       "capabilities": ["cap_net_raw"]}]})");

  const NodePlan& node = plan.nodes.at(1);
  REQUIRE(node.programs.size() == 1);
  const Program& agent = node.programs[0];
  CHECK(agent.kind == ProgramKind::kAgent);
  CHECK(agent.from_scenario);
  CHECK(agent.has_control_socket);
  CHECK(agent.arguments == std::vector<std::string>{"/scenarios/fly", "1"});
  CHECK(agent.capabilities.empty());
  CHECK(std::count(agent.environment.begin(), agent.environment.end(), "ME=10.42.0.2") == 1);
  CHECK(node.agent->node() == 1);
}

TEST_CASE("Each group is a formation of its own") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [
      {"name": "a", "count": 2},
      {"name": "b", "count": 3, "start": {"layout": "grid", "centre": ["50 m", "0 m", "0 m"]},
       "neighbours": {"source": "motion-capture"}}]})");

  const proto::AgentConfiguration& agent = plan.nodes.at(4).agent.value();
  CHECK(agent.name() == "b2");
  CHECK(agent.node() == 4);
  CHECK(agent.slot() == 2);
  CHECK(agent.fleet_size() == 3);
  CHECK(agent.slot_nodes(0) == 2);
  CHECK(agent.slot_nodes(2) == 4);
  CHECK(agent.beacon_port() != plan.nodes.at(0).agent.value().beacon_port());
  CHECK_FALSE(agent.has_circle());
  CHECK(plan.motion_capture_memory);
  CHECK(plan.nodes.at(4).sees_motion_capture);
  CHECK_FALSE(plan.nodes.at(0).sees_motion_capture);
}

TEST_CASE("Captures are of everybody, of those named, or of nobody") {
  const auto captured = [](const std::string& record) {
    return plan_of(R"({"name": "t", "fleet": [{"count": 2}], "record": )" + record + "}")
        .captured_nodes;
  };
  CHECK(captured(R"({})").empty());
  CHECK(captured(R"({"captures": true})") == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(captured(R"({"captures": ["gcs", "uav1"]})") == std::vector<std::uint32_t>{1, 2});

  const Plan plan = plan_of(R"({"name": "t", "fleet": [{}],
      "record": {"failed_receptions": true, "snap_length": 96}})");
  CHECK(plan.radio.capture_failed());
  CHECK(plan.radio.capture_snap_length() == 96);
}

TEST_CASE("Without the wish for real time nobody asks for it") {
  const Plan plan = plan_of(R"({"name": "t", "realtime": false, "fleet": [{}]})");

  CHECK(plan.world.realtime_priority() == 0);
  CHECK(plan.radio.realtime_priority() == 0);
  CHECK(plan.nodes.at(0).agent.value().realtime_priority() == 0);
}

TEST_CASE("A directly attached node has neither bridge nor veth") {
  const Plan plan = plan_of(R"({"name": "t", "network": {"attach": "direct"}, "fleet": [{}]})");

  CHECK(plan.nodes.at(0).bridge.empty());
  CHECK(plan.nodes.at(0).veth.empty());
  CHECK_FALSE(plan.radio.bridge());
}

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

TEST_CASE("A thousand nodes have a thousand addresses, and too small a network is refused") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [{"count": 999}]})");
  std::set<std::string> ips;
  std::set<std::string> macs;
  for (const NodePlan& node : plan.nodes) {
    ips.insert(node.ip);
    macs.insert(mac_text(node.mac));
    CHECK(node.veth.size() <= 15);  // IFNAMSIZ - 1
  }
  CHECK(ips.size() == 1000);
  CHECK(macs.size() == 1000);
  CHECK(plan.nodes.at(300).ip == "10.42.1.45");

  CHECK_THROWS_WITH(
      plan_of(R"({"name": "t", "network": {"subnet": "10.0.0.0/24"}, "fleet": [{"count": 254}]})"),
      Catch::Contains("has 254 addresses for 255 nodes"));
  CHECK_NOTHROW(
      plan_of(R"({"name": "t", "network": {"subnet": "10.0.0.0/24"}, "fleet": [{"count": 253}]})"));
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

TEST_CASE("The plan's text says what is not as in the default radio") {
  const auto text = [](const std::string& radio) {
    return to_text(plan_of(R"({"name": "t", "fleet": [{}], "radio": )" + radio + "}"));
  };

  CHECK_THAT(text(R"({"shadowing": {"deviation": "5 dB"}, "fading": {"model": "nakagami"},
                      "rate_control": "aarf"})"),
             Catch::Contains("friis, shadowing 5 dB, fading nakagami, rate control aarf\n"));
  CHECK_THAT(text(R"({"mac": {"model": "tdma"}})"), Catch::Contains("friis, tdma\n"));
  CHECK_THAT(text("{}"), Catch::Contains("friis\n"));
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

TEST_CASE("Every shipped scenario can be planned and printed") {
  int planned = 0;
  for (const auto& entry : std::filesystem::directory_iterator{kFolder}) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "scenario.schema") {
      continue;
    }
    CAPTURE(entry.path());
    const Plan plan = make_plan(scenario::load_scenario(entry.path()));

    CHECK(to_json(plan).at("nodes").size() == plan.nodes.size());
    CHECK_THAT(to_text(plan), Catch::StartsWith(entry.path().stem().string() + ": "));
    ++planned;
  }
  CHECK(planned >= 3);
}

}  // namespace
}  // namespace cuscus::orchestrator
