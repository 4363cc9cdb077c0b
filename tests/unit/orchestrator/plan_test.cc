#include "orchestrator/plan/plan.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "common/scenario/scenario_error.h"
#include "tests/unit/orchestrator/planned.h"

namespace cuscus::orchestrator {
namespace {

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
  CHECK(world.nodes(0).collision().behaviour() == "stop");
  CHECK(world.nodes(0).collision().restitution() == 0.3);
  CHECK(world.nodes(0).collision().radius_m() == Approx(0.3));
  CHECK_FALSE(world.nodes(10).has_multirotor());
  CHECK_FALSE(world.nodes(10).has_collision());
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

TEST_CASE("A vehicle has the view that its group is given, and no other") {
  const Plan plan = plan_of(R"({"name": "t", "fleet": [
      {"name": "a", "vehicle": {"model": "x4", "collision": {"behaviour": "crash"},
       "sensors": {"ultrasonic": {"direction": "left", "beam": "40 deg"},
                   "lidar": {"rays": 8, "elevations": ["-10 deg", "10 deg"]},
                   "gnss": {"rate": "10 Hz", "mask": "18 deg", "drift": "3 m"},
                   "camera": {"direction": "down", "height": 200, "offset": ["5 cm", "0 m", "0 m"]}}}},
      {"name": "b", "vehicle": {"model": "x4", "arm": "50 cm"},
       "start": {"layout": "list", "positions": [["5 m", "0 m", "0 m"]]}}]})");

  const proto::WorldNode& first = plan.world.nodes(0);
  CHECK(first.collision().behaviour() == "crash");
  CHECK(first.ultrasonic().period_ns() == 20'000'000);
  CHECK(first.ultrasonic().half_angle_rad() == Approx(0.34906585));
  CHECK(first.ultrasonic().axis_b().y() == 1.0);
  CHECK(first.lidar().period_ns() == 100'000'000);
  CHECK(first.lidar().rays() == 8);
  REQUIRE(first.lidar().elevations_rad_size() == 2);
  CHECK(first.lidar().elevations_rad(0) == Approx(-0.17453293));
  CHECK(first.gnss().period_ns() == 100'000'000);
  CHECK(first.gnss().mask_rad() == Approx(0.31415927));
  CHECK(first.gnss().drift_m() == 3.0);
  CHECK(first.gnss().correlation_time_ns() == 100'000'000'000);
  CHECK(plan.world.site().latitude_deg() == 49.4);
  CHECK(plan.world.epoch_unix_s() == 1'767'268'800);  // noon of the first day of 2026
  CHECK_FALSE(plan.world.nodes(1).has_gnss());
  CHECK_FALSE(plan.world.nodes(1).has_ultrasonic());
  CHECK_FALSE(plan.world.nodes(1).has_lidar());
  CHECK(plan.world.nodes(1).collision().radius_m() == Approx(0.6));  // its arm and 10 cm
  REQUIRE(plan.cameras);
  REQUIRE(plan.cameras->cameras_size() == 1);
  const proto::CameraNode& camera = plan.cameras->cameras(0);
  CHECK(camera.node() == 0);
  CHECK(camera.period_ns() == 50'000'000);
  CHECK(camera.width_px() == 320);
  CHECK(camera.height_px() == 200);
  CHECK(camera.field_rad() == Approx(1.22173048));
  CHECK(camera.pitch_rad() == Approx(1.57079633));
  CHECK(camera.p_bc_m().x() == 0.05);
  REQUIRE(plan.cameras->bodies_size() == 3);  // two vehicles and the ground station
  CHECK(plan.cameras->bodies(1).size_m().x() == Approx(1.2));
}

TEST_CASE("Two pings become two fixed nodes with a command each and nothing else") {
  const Plan plan = make_plan(scenario::load_scenario(kFolder / "two-pings.json"));

  REQUIRE(plan.nodes.size() == 2);
  CHECK_FALSE(plan.cameras);
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
