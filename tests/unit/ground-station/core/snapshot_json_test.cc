#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "ground-station/core/json_writer.h"
#include "ground-station/core/snapshot.h"

namespace cuscus::gcs {
namespace {

using nlohmann::json;

std::string string_as_json(std::string_view text) {
  JsonWriter writer;
  writer.string(text);
  return std::move(writer).take();
}

std::string number_as_json(double value, int decimals) {
  JsonWriter writer;
  writer.number(value, decimals);
  return std::move(writer).take();
}

TEST_CASE("numbers are short and never anything that JSON lacks") {
  CHECK(number_as_json(1.0, 3) == "1");
  CHECK(number_as_json(-12.3456, 3) == "-12.346");
  CHECK(number_as_json(0.1, 1) == "0.1");
  CHECK(number_as_json(100.0, 0) == "100");
  CHECK(number_as_json(-0.0001, 3) == "0");
  CHECK(number_as_json(std::numeric_limits<double>::quiet_NaN(), 3) == "null");
  CHECK(number_as_json(-std::numeric_limits<double>::infinity(), 3) == "null");
  CHECK(number_as_json(1e300, 3) == "null");
}

TEST_CASE("text is escaped for JSON and for HTML") {
  CHECK(string_as_json("uav3") == R"("uav3")");
  const std::string hostile{"</script>\"\\\n\0'&", 15};
  const std::string text = string_as_json(hostile);

  CHECK(json::parse(text).get<std::string>() == hostile);
  CHECK(text.find_first_of("<>&'") == std::string::npos);
}

TEST_CASE("what is not UTF-8 becomes the replacement character, byte by byte") {
  const std::string replacement = "\xEF\xBF\xBD";

  CHECK(json::parse(string_as_json("\xC3\xA9t\xC3\xA9 \xF0\x9F\x9A\x81")) == "été 🚁");
  CHECK(json::parse(string_as_json("a\xFF")) == "a" + replacement);
  CHECK(json::parse(string_as_json("\xC0\xAF")) == replacement + replacement);  // overlong
  CHECK(json::parse(string_as_json("\xED\xA0\x80")) ==
        replacement + replacement + replacement);                               // surrogate
  CHECK(json::parse(string_as_json("\xE2\x82")) == replacement + replacement);  // cut off
}

Snapshot example() {
  Snapshot snapshot{};
  snapshot.run_id = "r1";
  snapshot.scenario_name = "<b>";
  snapshot.state = RunState::kRunning;
  snapshot.now = sim_time(2'500'000'000);
  snapshot.duration = std::chrono::seconds{60};
  snapshot.circle = {.p_WC_centre_m = {1.0, 2.0, 3.0}, .radius_m = 40.0};
  snapshot.world = {.steps = 2500, .overruns = 3, .reached = sim_time(2'400'000'000)};
  shm::RadioTiming timing{};
  timing.release_lateness_p99_ns = 61'500;
  snapshot.radio = {.timing = timing, .reached = sim_time(2'600'000'000)};
  Snapshot::Node& uav = snapshot.nodes.emplace_back();
  uav.name = "uav0";
  uav.is_vehicle = true;
  uav.telemetry = {.sample = {.node = 0,
                              .sequence = 1,
                              .at = sim_time(2'250'000'000),
                              .p_WB_m = {1.0, 2.0, 3.0},
                              .v_WB_W_mps = {3.0, 0.0, 4.0},
                              .yaw_rad = 0.5,
                              .state = "flying",
                              .neighbours_heard = 9},
                   .age = std::chrono::milliseconds{250},
                   .received = 24,
                   .loss_ratio = 0.04,
                   .recent_loss_ratio = 0.0};
  uav.radio = shm::RadioTally{};
  uav.radio->lost_collision = 5;
  uav.telemetry_period = std::chrono::milliseconds{200};
  uav.hears = 7;
  snapshot.nodes.emplace_back().node = 1;
  snapshot.links = {{.a = 0,
                     .b = 1,
                     .received_dbm = -57.25,
                     .rate_kbps = 5'500,
                     .age = std::chrono::milliseconds{20},
                     .one_way = true}};
  return snapshot;
}

TEST_CASE("a snapshot in JSON says what it held") {
  const json document = json::parse(to_json(example()));

  CHECK(document["version"] == 2);
  CHECK(document["run"]["scenario"] == "<b>");
  CHECK(document["run"]["state"] == "running");
  CHECK(document["run"]["sim_time_s"] == 2.5);
  CHECK(document["run"]["duration_s"] == 60);
  CHECK(document["run"]["world"]["overruns"] == 3);
  CHECK(document["run"]["world"]["heartbeat_age_s"] == 0.1);
  CHECK(document["run"]["radio"]["heartbeat_age_s"] == 0);  // ahead of us: alive, not negative
  CHECK(document["run"]["radio"]["lateness_us"]["p99"] == 61.5);
  CHECK(document["circle"]["radius_m"] == 40);
  const json& uav = document["nodes"][0];
  CHECK(uav["telemetry_period_s"] == 0.2);
  CHECK(uav["hears"] == 7);
  CHECK(uav["telemetry"]["p_m"] == json({1, 2, 3}));
  CHECK(uav["telemetry"]["speed_mps"] == 5);
  CHECK(uav["telemetry"]["age_s"] == 0.25);
  CHECK(uav["telemetry"]["loss"] == 0.04);
  CHECK(uav["truth"].is_null());
  CHECK(uav["radio"]["lost"]["collision"] == 5);
  CHECK(document["nodes"][1]["telemetry"].is_null());
  CHECK(document["links"] == json::parse("[[0, 1, -57.2, 0.02, true, 5.5]]"));
}

TEST_CASE("a picture of an empty run is JSON as well") {
  Snapshot nothing{};
  nothing.state = RunState::kEnded;

  const json document = json::parse(to_json(nothing));

  CHECK(document["run"]["state"] == "ended");
  CHECK(document["run"]["world"].is_null());
  CHECK(document["run"]["radio"].is_null());
  CHECK(document["circle"].is_null());
  CHECK(document["nodes"] == json::array());
  CHECK(document["links"] == json::array());
}

}  // namespace
}  // namespace cuscus::gcs
