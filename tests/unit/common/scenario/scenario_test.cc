#include "common/scenario/scenario.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "common/scenario/placeholders.h"
#include "common/scenario/programs.h"
#include "common/scenario/scenario_error.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

const std::filesystem::path kFolder{CUSCUS_SCENARIO_FOLDER};

Scenario parse(const std::string& text, const std::vector<Override>& overrides = {}) {
  return parse_scenario(text, "flight.json", "/scenarios", overrides);
}

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{kFolder}) {
    if (entry.path().extension() == ".json" && entry.path().filename() != "scenario.schema.json") {
      files.push_back(entry.path());
    }
  }
  return files;
}

TEST_CASE("Two keys make a scenario, and the rest has the documented defaults") {
  const Scenario scenario = parse(R"({"name": "t", "fleet": [{}]})");

  CHECK(scenario.seed == 1);
  CHECK(scenario.duration == 60s);
  CHECK(scenario.radio.data_rate_kbps == 6000);
  CHECK(scenario.radio.basic_rates_kbps == std::vector<std::uint32_t>{6000, 12000, 24000});
  CHECK(scenario.radio.tx_power.value == 16.0);
  CHECK(subnet_text(scenario.network.subnet) == "10.42.0.0/16");
  CHECK(scenario.world.step == 1ms);
  CHECK(scenario.fleet.at(0).neighbours.beacon_period == 50ms);
  CHECK(scenario.fleet.at(0).neighbours.port == 47100);
  CHECK(std::get<X4Vehicle>(scenario.fleet.at(0).vehicle).mass_kg == 1.2);
  CHECK(scenario.fleet.at(0).autopilot);
  CHECK_FALSE(scenario.fleet.at(0).mission);
  CHECK(scenario.node_count() == 2);
}

TEST_CASE("The file's quantities arrive in SI units") {
  const Scenario scenario =
      parse(R"({"name": "t", "duration": "2 min",
      "radio": {"slot": "9 us", "data_rate": "54 Mb/s", "tx_power": "-3.5 dBm",
                "propagation": {"model": "log-distance", "exponent": 2.5,
                                "reference_loss": "46.7 dB"}},
      "world": {"imu": {"rate": "0.5 kHz"}, "motion_capture": {"attitude_noise": "180 deg"}},
      "fleet": [{}]})",
            {{.option = "x", .path = "world.motion_capture.attitude_noise", .value = "90 deg"}});

  CHECK(scenario.duration == 120s);
  CHECK(scenario.radio.slot == 9us);
  CHECK(scenario.radio.data_rate_kbps == 54000);
  CHECK(scenario.radio.tx_power.value == -3.5);
  const auto& model = std::get<LogDistancePropagation>(scenario.radio.propagation);
  CHECK(model.exponent == 2.5);
  CHECK(model.reference_loss.value().value == 46.7);
  CHECK(scenario.world.imu_period == 2ms);
  CHECK(scenario.world.motion_capture_noise_rad == std::numbers::pi / 2);
}

TEST_CASE("The scenario written out in full is the same scenario") {
  const std::string rich = R"({"name": "rich", "seed": 9223372036854775807, "clock": "real",
      "on_late": "stop",
      "radio": {"preamble_detection": "none", "basic_rates": ["24 Mb/s", "9 Mb/s"],
                "control_answer": "any-class", "preamble": "short", "rts_threshold": 500,
                "long_retry_limit": 4, "error_model": "yans", "rate_control": "minstrel", "capture": {"frame": "10 dB"},
                "shadowing": {"deviation": "6 dB", "decorrelation": "13 m"},
                "fading": {"model": "rice", "k_factor": "3 dB", "residual_doppler": "2 Hz"},
                "propagation": {"model": "paper-eq1", "alpha": 22.5, "chi": "9 dB2"}},
      "world": {"epoch": "2031-12-24T18:30:05Z", "site": {"latitude": -33.9, "height": "75 m"}},
      "network": {"subnet": "192.168.7.0/24", "attach": "direct", "neighbours": "arp",
                  "monitor": true},
      "fleet": [
        {"name": "a", "count": 3, "start": {"layout": "line", "direction": "33 deg",
         "centre": ["-7.25 m", "1 km", "0 m"], "heading": "-90 deg"},
         "vehicle": {"model": "x4", "mass": "1500 g", "faithful": true,
                     "collision": {"behaviour": "bounce", "restitution": 0.75, "radius": "45 cm"},
                     "sensors": {"ultrasonic": {"rate": "20 Hz", "direction": "forward", "beam": "12 deg"},
                                 "lidar": {"rays": 64, "field": "90 deg", "elevations": ["-15 deg", "0 deg", "7.5 deg"]},
                                 "gnss": {"rate": "10 Hz", "mask": "7.5 deg", "correlation_time": "5 min"},
                                 "camera": {"width": 640, "rate": "12.5 Hz", "offset": ["10 cm", "0 m", "-3 cm"],
                                            "direction": {"pitch": "30 deg", "yaw": "-90 deg"}}}},
         "mission": {"type": "circle", "centre": ["-7.25 m", "1 km"], "speed": "7 km/h"},
         "neighbours": {"source": "motion-capture", "beacon_period": "1 s"},
         "agent": ["./fly", "{index}"]},
        {"name": "b", "vehicle": {"model": "fixed"}, "command": ["./x/run", "{{}}", "{name}"],
         "environment": {"A": "{ip}"}, "capabilities": ["cap_net_raw"], "on_exit": "fail",
         "start": {"layout": "list", "positions": [["1 m", "2 m", "30 cm"]]}}],
      "ground_station": {"page": "none"},
      "record": {"frames": true, "receptions": true, "captures": ["b0", "a2"],
                 "failed_receptions": true, "snap_length": 128}})";
  std::vector<Scenario> scenarios{parse(rich)};
  for (
      const char* const radio :
      {R"({"standard": "802.11p", "fading": {"model": "nakagami", "m": 2.5}})",
       R"({"mac": {"model": "tdma", "slot": "4 ms", "guard": "1 us", "frame": ["gcs", "-", "uav0"]}})",
       R"({"disruption": {"fraction": 0.7, "interval": "2 s", "phase": "500 ms"}})",
       R"({"disruption": {"phase": "random"}})",
       R"({"antenna": "dipole"})",
       R"({"obstacles": [{"size": ["20 m", "10 m", "12 m"]},
           {"name": "tower", "centre": ["40 m", "-3 m"], "size": ["5 m", "5 m", "60 m"],
            "heading": "30 deg", "outer_wall": "concrete", "inner_walls": {"spacing": "4 m"}},
           {"size": ["1 m", "2 m", "3 m"], "outer_wall": "7.5 dB"}]})",
       R"({"jammers": [{"position": ["0 m", "20 m", "1 m"]},
           {"name": "pulsed", "position": ["0 m", "0 m", "1 m"], "power": "33 dBm", "duty": 0.2,
            "frequency": "2.44 GHz", "bandwidth": "5 MHz", "period": "3 ms", "start": "10 s",
            "stop": "20 s"}]})",
       R"({"propagation": {"model": "paper-eq1", "outer_wall": "15 dB", "inner_wall": "4 dB"}})",
       R"({"antenna": {"gains": [[-3, 1.5, 2], [4, 5, 6]]}})",
       R"({"mac": {"model": "tdma"}})",
       R"({"mac": {"model": "dcf"}})",
       R"({"standard": "802.11p", "mac": {"model": "edca"}})",
       R"({"mac": {"model": "ideal", "delay": "2 ms", "jitter": "500 us", "loss": 0.25, "range": "300 m"}})",
       R"({"mac": {"model": "ideal"}})",
       R"({"mac": {"model": "edca", "video": {"aifsn": 4, "cw_min": 31, "cw_max": 63}}})",
       R"({"standard": "802.11b", "fading": {"model": "rayleigh"}})",
       R"({"standard": "802.11a"})",
       R"({"propagation": {"model": "two-ray", "ground": "wet", "roughness": "5 cm"}})",
       R"({"propagation": {"model": "p1411", "bound": "upper"}})",
       R"({"propagation": {"model": "al-hourani", "environment": "high-rise"}})",
       R"({"propagation": {"model": "tr36777", "scenario": "RMa-AV", "line_of_sight": "mean"}})"}) {
    scenarios.push_back(
        parse(R"({"name": "t", "fleet": [{}], "radio": )" + std::string{radio} + "}"));
  }
  for (const auto& file : shipped()) {
    scenarios.push_back(load_scenario(file));
  }

  for (const Scenario& scenario : scenarios) {
    const std::string once = to_json(scenario).dump(2);
    INFO(once);

    const Scenario again = parse_scenario(once, "resolved", scenario.folder);

    CHECK(to_json(again).dump(2) == once);
  }
  CHECK(scenarios.front().fleet.at(0).neighbours.timeout == 3s);  // three beacon periods
  CHECK(scenarios.front().fleet.at(1).command.front() == "/scenarios/x/run");
}

TEST_CASE("An antenna's gains can be in a file beside the scenario") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("cuscus-antenna-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const auto antenna_of = [&](const std::string& rows) {
    std::ofstream{folder / "a.csv"} << rows;
    return parse_scenario(
               R"({"name": "t", "fleet": [{}], "radio": {"antenna": {"file": "a.csv"}}})",
               "flight.json", folder, {})
        .radio.antenna;
  };

  const Antenna antenna = antenna_of("# -90, 0 and 90 degrees\n-3, 1.5\n\n0,+2\r\n4 ,5");
  const std::vector<std::vector<double>> expected{{-3.0, 1.5}, {0.0, 2.0}, {4.0, 5.0}};
  CHECK(std::get<PatternAntenna>(antenna).gains_dBi == expected);
  for (const char* const bad : {"1,2\n1", "1,x\n1,2", "1,2\n1,nan", "", "1,2\n1,50", "1,2\n1,"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(antenna_of(bad), ScenarioError);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("Every shipped scenario loads, and uses the schema beside it") {
  const auto files = shipped();

  REQUIRE(files.size() >= 3);
  for (const auto& file : files) {
    CAPTURE(file);
    std::ifstream stream{file};
    CHECK(json::parse(stream).at("$schema") == "./scenario.schema.json");
    CHECK(load_scenario(file).name == file.stem());
  }
}

TEST_CASE("A radio has the defaults of its standard") {
  const auto radio_of = [](const std::string& standard) {
    return parse(R"({"name": "t", "fleet": [{}], "radio": {"standard": ")" + standard + "\"}}")
        .radio;
  };

  CHECK(radio_of("802.11b").data_rate_kbps == 1000);
  CHECK(radio_of("802.11b").basic_rates_kbps == std::vector<std::uint32_t>{1000, 2000});
  CHECK(radio_of("802.11a").slot == 9us);
  CHECK(radio_of("802.11a").channel_frequency_hz == 5.18e9);
  CHECK(radio_of("802.11p").slot == 13us);
  CHECK(radio_of("802.11p").basic_rates_kbps == std::vector<std::uint32_t>{3000, 6000, 12000});
}

TEST_CASE("The default scenario is the paper's fleet") {
  const Scenario scenario = load_scenario(kFolder / "default.json");

  CHECK(scenario.uav_count() == 10);
  CHECK(scenario.duration == 60s);
  const Group& group = scenario.fleet.at(0);
  CHECK(group.mission.value().radius_m == 20.0);
  CHECK(group.mission.value().altitude_m == 10.0);
  CHECK(group.mission.value().speed_mps == 2.0);
  CHECK(group.neighbours.beacon_period == 50ms);
  CHECK(scenario.ground_station.page_port == 8080);
}

/// All keys below `schema`, with those of alternatives and of referenced definitions.
void collect_keys(const json& schema, std::set<std::string>& keys) {
  if (schema.is_object()) {
    if (schema.contains("properties")) {
      for (const auto& [key, value] : schema.at("properties").items()) {
        keys.insert(key);
      }
    }
    for (const auto& [key, value] : schema.items()) {
      collect_keys(value, keys);
    }
  } else if (schema.is_array()) {
    for (const json& element : schema) {
      collect_keys(element, keys);
    }
  }
}

TEST_CASE("Every key of the schema is described in docs/scenario.md") {
  std::set<std::string> keys;
  collect_keys(json::parse(scenario_schema()), keys);
  std::ifstream stream{kFolder.parent_path() / "docs" / "scenario.md"};
  const std::string page{std::istreambuf_iterator<char>{stream}, {}};

  REQUIRE(keys.size() > 60);
  for (const std::string& key : keys) {
    CAPTURE(key);
    CHECK(page.find('`' + key + '`') != std::string::npos);
  }
}

TEST_CASE("The schema's defaults are the ones that the reader fills in") {
  const json resolved = json::parse(to_json(parse(R"({"name": "t", "fleet": [{}]})")).dump());
  const json schema = json::parse(scenario_schema());
  int compared = 0;
  const std::function<void(const json&, const json&, const std::string&)> compare =
      [&](const json& node, const json& value, const std::string& path) {
        if (node.contains("default") && path != "/description") {
          CAPTURE(path);
          CHECK(node.at("default") == value);
          ++compared;
        }
        if (node.contains("items") && value.is_array() && value.size() == 1) {
          compare(node.at("items"), value.at(0), path + "/0");
        }
        for (const json& alternative : node.value("anyOf", json::array())) {
          const json& properties = alternative.value("properties", json::object());
          const std::string tag = properties.contains("layout") ? "layout" : "model";
          if (!value.is_object() ||
              (properties.contains(tag) && properties.at(tag).at("enum").at(0) != value.at(tag))) {
            continue;
          }
          compare(alternative, value, path);
        }
        if (!node.contains("properties") || !value.is_object()) {
          return;
        }
        for (const auto& [key, child] : node.at("properties").items()) {
          if (value.contains(key)) {
            compare(child, value.at(key), path + '/' + key);
          }
        }
      };

  compare(schema, resolved, "");

  CHECK(compared > 50);
}

TEST_CASE("Options replace values, create objects and reach into the fleet") {
  const Scenario scenario =
      parse(R"({"name": "t", "fleet": [{"count": 2}]})",
            {parse_override("fleet.0.count=5"),
             parse_override("radio.data_rate=\"12 Mb/s\""),
             parse_override("radio.group_rate=24 Mb/s"),
             parse_override("ground_station.page=none"),
             parse_override("realtime=false"),
             {.option = "--duration 90s", .path = "duration", .value = "90s"}});

  CHECK(scenario.fleet.at(0).count == 5);
  CHECK(scenario.radio.data_rate_kbps == 12000);
  CHECK(scenario.radio.group_rate_kbps == 24000);
  CHECK_FALSE(scenario.ground_station.page_port);
  CHECK_FALSE(scenario.realtime);
  CHECK(scenario.duration == 90s);
}

TEST_CASE("A file that cannot be a scenario is refused by its name") {
  CHECK_THROWS_WITH(load_scenario("/nonexistent/a.json"), "/nonexistent/a.json: does not exist");
  CHECK_THROWS_WITH(load_scenario("/"), "/: is not a file");
  CHECK_THROWS_WITH(load_scenario("/dev/zero"), "/dev/zero: is not a file");
}

TEST_CASE("A fleet of one thousand is allowed") {
  const Scenario scenario =
      parse(R"({"name": "t", "fleet": [{"count": 1000}], "ground_station": {"enabled": false}})");

  CHECK(scenario.uav_count() == 1000);
}

TEST_CASE("A grid is square, centred, with equal steps") {
  Group group;
  group.count = 4;
  group.start.layout = GridLayout{.spacing_m = 2.0, .centre_m = {10.0, 20.0, 0.0}};

  const auto positions = start_positions(group);

  CHECK(positions == std::vector<Position_m>{
                         {9.0, 19.0, 0.0}, {11.0, 19.0, 0.0}, {9.0, 21.0, 0.0}, {11.0, 21.0, 0.0}});
}

TEST_CASE("A circle begins in the east and goes counter-clockwise") {
  Group group;
  group.count = 4;
  group.start.layout = CircleLayout{.radius_m = 20.0, .centre_m = {1.0, 0.0, 5.0}};

  const auto positions = start_positions(group);

  REQUIRE(positions.size() == 4);
  CHECK(positions[0][0] == Approx(21.0));
  CHECK(positions[1][1] == Approx(20.0));
  CHECK(positions[2][0] == Approx(-19.0));
  CHECK(positions[3][2] == 5.0);
}

TEST_CASE("A line is centred and runs in its direction") {
  Group group;
  group.count = 3;
  group.start.layout = LineLayout{
      .spacing_m = 2.0, .centre_m = {0.0, 1.0, 0.0}, .direction_rad = std::numbers::pi / 2};

  const auto positions = start_positions(group);

  REQUIRE(positions.size() == 3);
  CHECK(positions[0][1] == Approx(-1.0));
  CHECK(positions[1][1] == Approx(1.0));
  CHECK(positions[2][1] == Approx(3.0));
  CHECK(positions[2][0] == Approx(0.0).margin(1e-12));
}

TEST_CASE("Placeholders stand for the UAV's own values, doubled braces for braces") {
  PlaceholderValues values;
  values.index = "3";
  values.name = "uav3";
  values.ip = "10.42.0.4";
  values.ip_of = [](const std::string& name) {
    return name == "uav7" ? std::optional<std::string>{"10.42.0.8"} : std::nullopt;
  };

  CHECK(expand("--id={index}/{name}@{ip}", values) == "--id=3/uav3@10.42.0.4");
  CHECK(expand("{ip:uav7}", values) == "10.42.0.8");
  CHECK(expand("{{print $1}}", values) == "{print $1}");
  CHECK(expand("", values).empty());
  CHECK_THROWS_WITH(expand("{", values), Catch::Contains("without a }"));
  CHECK_THROWS_WITH(expand("}", values), Catch::Contains("without a {"));
  CHECK_THROWS_WITH(expand("{ip:uav8}", values), Catch::Contains("there is no \"uav8\""));
}

TEST_CASE("Programs are looked for where the run will look") {
  const auto check = [](const std::string& program) {
    check_programs(parse(R"({"name": "t", "fleet": [{"command": [")" + program + R"("]}]})"),
                   "flight.json", "/nonexistent:/bin:/usr/bin");
  };

  CHECK_NOTHROW(check("sh"));
  CHECK_NOTHROW(check("/bin/sh"));
  CHECK_NOTHROW(check("./agent-{index}"));  // known only in the run
  CHECK_THROWS_WITH(check("no-such-program"),
                    Catch::StartsWith("flight.json: /fleet/0/command/0: \"no-such-program\" is not "
                                      "in /nonexistent:/bin:/usr/bin"));
  CHECK_THROWS_WITH(check("./no-such-program"),
                    Catch::Contains("\"/scenarios/no-such-program\" is not there"));
  CHECK_THROWS_WITH(check("/etc/passwd"), Catch::Contains("not executable"));
  CHECK_THROWS_WITH(
      check_programs(parse(R"({"name": "t", "fleet": [{"agent": ["./no-such-agent"]}]})"),
                     "flight.json", "/bin"),
      Catch::StartsWith(
          "flight.json: /fleet/0/agent/0: \"/scenarios/no-such-agent\" is not there"));
}

TEST_CASE("IPv4 networks are four small numbers and a prefix") {
  const auto subnet = parse_subnet("10.42.0.0/16");

  REQUIRE(subnet);
  CHECK(subnet->host_count() == 65534);
  CHECK(ipv4_text(subnet->host(0)) == "10.42.0.1");
  CHECK(ipv4_text(subnet->broadcast()) == "10.42.255.255");
  for (const char* text : {"", "10.42.0/16", "10.42.0.0.0/16", "256.0.0.0/8", "010.0.0.0/8",
                           "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/8 ", "-1.0.0.0/8", "a.b.c.d/8"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_subnet(text));
  }
}

}  // namespace
}  // namespace cuscus::scenario
