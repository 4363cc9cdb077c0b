#include <array>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/scenario/scenario.h"
#include "common/scenario/scenario_error.h"
#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

constexpr const char* kSource = "flight.json";

ScenarioError error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    static_cast<void>(parse_scenario(text, kSource, "/scenarios", overrides));
  } catch (const ScenarioError& error) {
    return error;
  }
  FAIL("was accepted: " << text);
  throw std::logic_error{"not reached"};
}

struct BadInput {
  const char* patch;  ///< JSON merge patch (RFC 7396) for {"name": "t", "fleet": [{}]}.
  const char* path;
  const char* fragment;
  bool schema_rejects;  ///< Whether an editor can already see it.
};

// clang-format off
const std::vector<BadInput> kTable{
    {R"({"name": null})", "/name", "is missing; allowed: letters", true},
    {R"({"name": 5})", "/name", "5 is a number; allowed: a text", true},
    {R"({"name": "../etc"})", "/name", "\"../etc\" cannot name a run directory", true},
    {R"({"name": "nul\u0000"})", "/name", "has a NUL character", true},
    {R"({"sede": 3})", "/sede", "is not a known key; did you mean \"seed\"? allowed: $schema, name, description, seed", true},
    {R"({"a/b~c": 3})", "/a~1b~0c", "is not a known key", true},
    {R"({"seed": -1})", "/seed", "-1 is out of range or not whole; allowed: a whole number 0 ...", true},
    {R"({"seed": 1.5})", "/seed", "1.5 is out of range or not whole", true},
    {R"({"seed": "1"})", "/seed", "\"1\" is a text; allowed: a whole number", true},
    {R"({"duration": 60})", "/duration", "60 is a number without a unit; allowed: a time as a text, such as \"50 ms\"", true},
    {R"({"duration": "60"})", "/duration", "\"60\" has no unit; allowed: a time in ns, us, ms, s, min, h", true},
    {R"({"duration": "0 s"})", "/duration", "\"0 s\" is out of range; allowed: 1 s ... 24 h", false},
    {R"({"duration": "2 fortnights"})", "/duration", "has the unit \"fortnights\"", true},
    {R"({"clock": "virtual"})", "/clock", "\"virtual\" is not built yet; allowed: real", true},
    {R"({"clock": "reel"})", "/clock", "\"reel\" is not known; did you mean \"real\"? allowed: real", true},
    {R"({"on_late": "abort"})", "/on_late", "\"abort\" is not known; allowed: warn, fail, stop", true},
    {R"({"realtime": "yes"})", "/realtime", "\"yes\" is a text; allowed: true, false", true},
    {R"({"radio": 3})", "/radio", "3 is a number; allowed: an object", true},
    {R"({"radio": {"data_rat": "6 Mb/s"}})", "/radio/data_rat", "did you mean \"data_rate\"? allowed: standard, data_rate", true},
    {R"({"radio": {"data_rate": "7 Mb/s"}})", "/radio/data_rate", "\"7 Mb/s\" is not a rate of 802.11g; allowed: 1, 2, 5.5, 6, 9, 11, 12, 18, 24, 36, 48, 54 Mb/s", false},
    {R"({"radio": {"basic_rates": []}})", "/radio/basic_rates", "an array of at least one of", true},
    {R"({"radio": {"basic_rates": ["6 Mb/s", "6000 kb/s"]}})", "/radio/basic_rates/1", "is given twice", false},
    {R"({"radio": {"standard": "802.11n"}})", "/radio/standard", "is not known; did you mean \"802.11a\"? allowed: 802.11a, 802.11b, 802.11g, 802.11p", true},
    {R"({"radio": {"standard": "802.11p", "data_rate": "54 Mb/s"}})", "/radio/data_rate", "is not a rate of 802.11p; allowed: 3, 4.5, 6, 9, 12, 18, 24, 27 Mb/s", false},
    {R"({"radio": {"standard": "802.11a", "preamble": "short"}})", "/radio/preamble", "\"short\" is of DSSS and CCK rates, which 802.11a does not have; allowed: long", false},
    {R"({"radio": {"rts_threshold": "off"}})", "/radio/rts_threshold", "allowed: none, or a whole number of bytes 0 ... 65535", true},
    {R"({"radio": {"rts_threshold": 70000}})", "/radio/rts_threshold", "allowed: a whole number 0 ... 65535", true},
    {R"({"radio": {"shadowing": "some"}})", "/radio/shadowing", "allowed: none, or an object with deviation and decorrelation", true},
    {R"({"radio": {"shadowing": {"deviation": "40 dB"}}})", "/radio/shadowing/deviation", "out of range; allowed: 0.01 dB ... 30 dB", false},
    {R"({"radio": {"fading": {"model": "ricean"}}})", "/radio/fading/model", "did you mean \"rice\"? allowed: rice, rayleigh, nakagami", true},
    {R"({"radio": {"fading": {}}})", "/radio/fading/model", "is missing; allowed: rice, rayleigh, nakagami", true},
    {R"({"radio": {"fading": {"model": "rayleigh", "k_factor": "3 dB"}}})", "/radio/fading/k_factor", "is not a known key; allowed: model, residual_doppler", true},
    {R"({"radio": {"fading": {"model": "nakagami", "m": 0.1}}})", "/radio/fading/m", "allowed: a number 0.5 ... 1000.0", true},
    {R"({"radio": {"antenna": "yagi"}})", "/radio/antenna", "allowed: isotropic, dipole, or an object with either gains or file", true},
    {R"({"radio": {"antenna": {}}})", "/radio/antenna", "allowed: isotropic, dipole, or an object with either gains or file", true},
    {R"({"radio": {"antenna": {"gains": [[1, 2]]}}})", "/radio/antenna/gains", "has 1 rows; allowed: 2 ... 361", true},
    {R"({"radio": {"antenna": {"gains": [[1, 2], [1]]}}})", "/radio/antenna/gains", "row 2 has 1 numbers and row 1 has 2; allowed: 1 ... 720, as many in every row", false},
    {R"({"radio": {"antenna": {"gains": [[1, 2], [1, "2 dB"]]}}})", "/radio/antenna/gains", "row 2, number 2 is no gain; allowed: a number of dBi, -100 ... 40", true},
    {R"({"radio": {"antenna": {"file": "../a.csv"}}})", "/radio/antenna/file", "allowed: the name of a file beside the scenario", false},
    {R"({"radio": {"antenna": {"file": "absent.csv"}}})", "/radio/antenna/file", "\"absent.csv\" cannot be read", false},
    {R"({"radio": {"obstacles": [{"size": ["1 m", "1 m", "1 m"]}], "propagation": {"model": "tr36777"}}})", "/radio/obstacles", "are a map, and the model of radio/propagation stands in for one by chance of line of sight; allowed: friis, log-distance,", false},
    {R"({"radio": {"obstacles": [{"size": ["1 m", "1 m", "1 m"]}], "propagation": {"model": "al-hourani"}}})", "/radio/obstacles", "are a map,", false},
    {R"({"radio": {"obstacles": [{"centre": ["1 m", "1 m"]}]}})", "/radio/obstacles/0/size", "is missing; allowed: length, width and height", true},
    {R"({"radio": {"obstacles": [{"size": ["1 m", "0 m", "1 m"]}]}})", "/radio/obstacles/0/size", "allowed: length, width and height from 1 cm", false},
    {R"({"radio": {"obstacles": [{"size": ["1 m", "1 m", "1 m"], "outer_wall": "brick"}]}})", "/radio/obstacles/0/outer_wall", "\"brick\" is not known; allowed: stone, concrete, or a loss of 0.01 dB ... 300 dB", true},
    {R"({"radio": {"obstacles": [{"size": ["1 m", "1 m", "1 m"], "inner_walls": {"spacing": "1 cm"}}]}})", "/radio/obstacles/0/inner_walls/spacing", "out of range; allowed: 0.5 m ... 1 km", false},
    {R"({"radio": {"obstacles": [{"name": "a", "size": ["1 m", "1 m", "1 m"]}, {"name": "a", "size": ["1 m", "1 m", "1 m"]}]}})", "/radio/obstacles/1/name", "\"a\" is given twice; allowed: each name once", false},
    {R"({"radio": {"obstacles": {}}})", "/radio/obstacles", "allowed: an array of up to 1000 objects", true},
    {R"({"radio": {"jammers": [{}]}})", "/radio/jammers/0/position", "is missing; allowed: east, north and up", true},
    {R"({"radio": {"jammers": [{"position": ["0 m", "0 m", "1 m"], "duty": 0}]}})", "/radio/jammers/0/duty", "0 is out of range; allowed: a number 0.001 ... 1.0", true},
    {R"({"radio": {"jammers": [{"position": ["0 m", "0 m", "1 m"], "start": "2 s", "stop": "1 s"}]}})", "/radio/jammers/0/stop", "\"1 s\" is not after the start; allowed: none, or a later time", false},
    {R"({"radio": {"disruption": "often"}})", "/radio/disruption", "allowed: none, or an object with fraction, interval and phase", true},
    {R"({"radio": {"disruption": {"fraction": 40}}})", "/radio/disruption/fraction", "40 is out of range; allowed: a number 0.0 ... 1.0", true},
    {R"({"radio": {"disruption": {"phase": "2 s"}}})", "/radio/disruption/phase", "is beyond the interval; allowed: random, or a time of at most the interval", false},
    {R"({"radio": {"tx_power": "100 mW"}})", "/radio/tx_power", "has the unit \"mW\"; allowed: a power level in dBm", true},
    {R"({"radio": {"tx_power": "90 dBm"}})", "/radio/tx_power", "out of range; allowed: -50 dBm ... 50 dBm", false},
    {R"({"radio": {"rts_threshold": 500, "mac": {"model": "tdma"}}})", "/radio/rts_threshold", "500 announces frames, and tdma does not; allowed: none", false},
    {R"({"radio": {"mac": "tdma"}})", "/radio/mac", "\"tdma\" is a text; allowed: an object", true},
    {R"({"radio": {"mac": {}}})", "/radio/mac/model", "is missing; allowed: dcf, edca, tdma, ideal", true},
    {R"({"radio": {"mac": {"model": "tmda"}}})", "/radio/mac/model", "did you mean \"tdma\"? allowed: dcf, edca, tdma, ideal", true},
    {R"({"radio": {"mac": {"model": "dcf", "slot": "2 ms"}}})", "/radio/mac/slot", "is not a known key; allowed: model", true},
    {R"({"radio": {"mac": {"model": "edca", "vioce": {}}}})", "/radio/mac/vioce", "did you mean \"voice\"?", true},
    {R"({"radio": {"mac": {"model": "edca", "voice": {"aifsn": 1}}}})", "/radio/mac/voice/aifsn", "allowed: a whole number 2 ... 15", true},
    {R"({"radio": {"mac": {"model": "edca", "video": {"cw_min": 8}}}})", "/radio/mac/video/cw_min", "8 is no contention window; allowed: 0, 1, 3, 7, 15, ... 32767", false},
    {R"({"radio": {"mac": {"model": "edca", "voice": {"cw_min": 15}}}})", "/radio/mac/voice/cw_min", "15 is above cw_max; allowed: up to 7", false},
    {R"({"radio": {"mac": {"model": "edca", "voice": 3}}})", "/radio/mac/voice", "3 is a number; allowed: an object", true},
    {R"({"radio": {"mac": {"model": "ideal", "loss": 1.5}}})", "/radio/mac/loss", "allowed: a number 0.0 ... 1.0", true},
    {R"({"radio": {"mac": {"model": "ideal", "delay": "1 ms", "jitter": "2 ms"}}})", "/radio/mac/jitter", "is longer than the delay, which varies by it; allowed: up to 1 ms", false},
    {R"({"radio": {"mac": {"model": "ideal", "range": "-3 m"}}})", "/radio/mac/range", "out of range; allowed: 1 cm ... 1000 km", false},
    {R"({"radio": {"mac": {"model": "ideal"}, "rate_control": "ideal"}})", "/radio/rate_control", "\"ideal\" learns from ACKs, and ideal has none; allowed: constant", false},
    {R"({"radio": {"mac": {"model": "tdma", "slot": "2 s"}}})", "/radio/mac/slot", "out of range; allowed: 100 us ... 1 s", false},
    {R"({"radio": {"mac": {"model": "tdma", "slot": "2 ms"}}})", "/radio/mac/slot", "\"2 ms\" is too short for an IP packet of 1500 B (network/mtu) at the data_rate of 6 Mb/s and the guard time; allowed: from 2.088 ms", false},
    {R"({"radio": {"mac": {"model": "tdma", "slot": "1 ms"}, "data_rate": "54 Mb/s"}})", "/radio/mac/slot", "at the group_rate of 6 Mb/s", false},
    {R"({"radio": {"mac": {"model": "tdma", "guard": "3 ms"}}})", "/radio/mac/guard", "is no shorter than the slot; allowed: less than 2.5 ms", false},
    {R"({"radio": {"mac": {"model": "tdma", "frame": "all"}}})", "/radio/mac/frame", "\"all\"; allowed: nodes, or an array of 1 ... 10000 node names", true},
    {R"({"radio": {"mac": {"model": "tdma", "frame": []}}})", "/radio/mac/frame", "allowed: nodes, or an array of 1 ... 10000 node names", true},
    {R"({"radio": {"mac": {"model": "tdma", "frame": ["uav0", 1]}}})", "/radio/mac/frame/1", "1 is a number; allowed: a text", true},
    {R"({"radio": {"mac": {"model": "tdma", "frame": ["uav0", "-", "uav1"]}}})", "/radio/mac/frame/2", "\"uav1\" is no node; did you mean \"uav0\"? allowed: names of nodes, such as \"gcs\", or \"-\"", false},
    {R"({"radio": {"mac": {"model": "tdma"}, "rate_control": "aarf"}})", "/radio/rate_control", "\"aarf\" learns from ACKs, and tdma has none; allowed: constant", false},
    {R"({"radio": {"queue": {"frames": 0}}})", "/radio/queue/frames", "allowed: a whole number 1 ... 100000", true},
    {R"({"radio": {"retry_limit": 1e3}})", "/radio/retry_limit", "1000.0 is out of range or not whole", true},
    {R"({"radio": {"preamble_detection": "never"}})", "/radio/preamble_detection", "allowed: none, or an object", true},
    {R"({"radio": {"propagation": {"model": "freis"}}})", "/radio/propagation/model", "did you mean \"friis\"? allowed: friis, log-distance, paper-eq1, two-ray, p1411, al-hourani, tr36777", true},
    {R"({"radio": {"propagation": {"model": "al-hourani", "environment": "rural"}}})", "/radio/propagation/environment", "allowed: suburban, urban, dense-urban, high-rise", true},
    {R"({"radio": {"propagation": {"model": "tr36777", "line_of_sight": "mean", "decorrelation": "9 m"}}})", "/radio/propagation/decorrelation", "is not a known key; allowed: model, scenario, line_of_sight", false},
    {R"({"radio": {"propagation": {}}})", "/radio/propagation/model", "is missing; allowed: friis", true},
    {R"({"radio": {"propagation": {"model": "friis", "exponent": 3}}})", "/radio/propagation/exponent", "is not a known key; allowed: model", true},
    {R"({"radio": {"propagation": {"model": "log-distance", "exponent": -2}}})", "/radio/propagation/exponent", "-2 is out of range; allowed: a number 0.0 ... 10.0", true},
    {R"({"network": {"subnet": "10.42.0.0"}})", "/network/subnet", "is not an IPv4 network", true},
    {R"({"network": {"subnet": "10.42.0.1/16"}})", "/network/subnet", "has host bits set; allowed: the network itself, here \"10.42.0.0/16\"", false},
    {R"({"network": {"subnet": "10.42.0.0/31"}})", "/network/subnet", "allowed: /8 ... /30", false},
    {R"({"network": {"subnet": "127.0.0.0/8"}})", "/network/subnet", "is no network for hosts", false},
    {R"({"network": {"subnet": "10.42.0.0/30"}, "fleet": [{"count": 3}]})", "/network/subnet", "has 2 addresses for 4 nodes", false},
    {R"({"network": {"mtu": 9000}})", "/network/mtu", "9000 is out of range or not whole; allowed: a whole number 576 ... 1500", true},
    {R"({"network": {"mtu": 1000, "ipv6": true}})", "/network/mtu", "allowed: a whole number 1280 ... 1500", false},
    {R"({"world": {"imu": {"rate": "300 Hz"}}})", "/world/imu/rate", "allowed: a whole number of world steps of 1 ms", false},
    {R"({"world": {"imu": {"rate": "10 Hz"}}})", "/world/imu/rate", "takes the sensor for lost after 100 ms; allowed: more than 10 Hz", false},
    {R"({"world": {"motion_capture": {"rate": "5 Hz"}}})", "/world/motion_capture/rate", "has a period of 200 ms, and the autopilot takes the sensor for lost after 200 ms; allowed: more than 5 Hz", false},
    {R"({"world": {"motion_capture": {"position_noise": "2 m"}}})", "/world/motion_capture/position_noise", "allowed: 0 m ... 1 m", false},
    {R"({"world": {"epoch": "noon"}})", "/world/epoch", "\"noon\" is no time of 1980 ... 2099 in UTC; allowed: such as \"2026-01-01T12:00:00Z\"", false},
    {R"({"world": {"site": {"latitude": 91}}})", "/world/site/latitude", "91 is out of range; allowed: a number -90.0 ... 90.0", true},
    {R"({"world": {"site": {}}, "city": {"generate": "grid"}})", "/world/site", "allowed: no site beside a city", false},
    {R"({"world": {"step": "1 s"}})", "/world/step", "allowed: 100 us ... 10 ms", false},
    {R"({"fleet": null})", "/fleet", "is missing; allowed: an array of 1 ... 100 groups", true},
    {R"({"fleet": []})", "/fleet", "has 0 elements; allowed: an array of 1 ... 100 groups", true},
    {R"({"fleet": {"uav": 3}})", "/fleet", "an object is not an array", true},
    {R"({"fleet": [{"count": 0}]})", "/fleet/0/count", "0 is out of range or not whole; allowed: a whole number 1 ... 1000", true},
    {R"({"fleet": [{"count": 5000}]})", "/fleet/0/count", "5000 is out of range or not whole; allowed: a whole number 1 ... 1000", true},
    {R"({"fleet": [{"name": "a", "count": 600}, {"name": "b", "count": 600, "start": {"layout": "grid", "centre": ["1 km", "0 m", "0 m"]}}]})", "/fleet", "has 1200 UAVs; allowed: 1 ... 1000", false},
    {R"({"network": {"subnet": "10.42.0.0/16"}, "fleet": [{"count": 1000, "start": {"layout": "grid"}}]})", "/fleet", "has 1000 UAVs, which are 1001 nodes with the ground station; allowed: 1 ... 1000", false},
    {R"({"fleet": [{"name": "UAV 1"}]})", "/fleet/0/name", "\"UAV 1\" is not a group's name", true},
    {R"({"fleet": [{"name": "gcs"}]})", "/fleet/0/name", "\"gcs\" is the ground station", false},
    {R"({"fleet": [{"name": "uav"}, {"name": "uav", "start": {"layout": "grid", "centre": ["9 m", "0 m", "0 m"]}}]})", "/fleet/1/name", "\"uav\" is the name of a group before", false},
    {R"({"fleet": [{"vehicle": {"model": "x8"}}]})", "/fleet/0/vehicle/model", "allowed: x4, fixed", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "mass": "4 kg"}}]})", "/fleet/0/vehicle/mass", "\"4 kg\" is more than an x4 lifts; allowed: less than", false},
    {R"({"fleet": [{"vehicle": {"model": "fixed", "mass": "1 kg"}}]})", "/fleet/0/vehicle/mass", "is not a known key; allowed: model", true},
    {R"({"fleet": [{"vehicle": {"model": "fixed"}, "autopilot": true}]})", "/fleet/0/autopilot", "the vehicle is fixed; allowed: false", false},
    {R"({"fleet": [{"vehicle": {"model": "fixed"}, "mission": {"type": "circle"}}]})", "/fleet/0/mission", "needs the autopilot", false},
    {R"({"fleet": [{"start": {"radius": "3 m"}}]})", "/fleet/0/start/layout", "is missing; allowed: grid, circle, line, list", true},
    {R"({"fleet": [{"start": {"layout": "grid", "spacing": "0 m"}}]})", "/fleet/0/start/spacing", "allowed: 10 cm ... 10 km", false},
    {R"({"fleet": [{"start": {"layout": "grid", "centre": ["0 m", "0 m"]}}]})", "/fleet/0/start/centre", "an array of 2; allowed: an array of 3 lengths", true},
    {R"({"fleet": [{"start": {"layout": "grid", "centre": ["0 m", "0 m", "-3 m"]}}]})", "/fleet/0/start", "uav0 is below the ground, at z = -3 m", false},
    {R"({"fleet": [{"count": 4, "start": {"layout": "grid", "centre": ["0 m", "0 m", "3 m"]}}]})", "/fleet/0/start", "uav0 is above the ground, at z = 3 m, from where it would fall; allowed: z = 0 m", false},
    {R"({"fleet": [{"count": 2, "start": {"layout": "list", "positions": [["0 m", "0 m", "0 m"]]}}]})", "/fleet/0/start/positions", "has 1 elements; allowed: 2 positions", false},
    {R"({"fleet": [{"count": 1, "start": {"layout": "list", "positions": [["0 m", "0 s", "0 m"]]}}]})", "/fleet/0/start/positions/0/1", "\"0 s\" has the unit \"s\"", true},
    {R"({"fleet": [{"count": 2, "start": {"layout": "list", "positions": [["0 m", "0 m", "0 m"], ["0 m", "0 m", "0 m"]]}}]})", "/fleet/0/start", "uav1 is where uav0 is", false},
    {R"({"fleet": [{"mission": "circle"}]})", "/fleet/0/mission", "allowed: none, or an object with a type", true},
    {R"({"fleet": [{"mission": {"radius": "20 m"}}]})", "/fleet/0/mission/type", "is missing; allowed: circle", true},
    {R"({"fleet": [{"mission": {"type": "circle", "speed": "300 m/s"}}]})", "/fleet/0/mission/speed", "allowed: 0 m/s ... 30 m/s", false},
    {R"({"fleet": [{"mission": {"type": "circle", "radius": "20 m", "speed": "6 m/s"}}]})", "/fleet/0/mission/speed", "\"6 m/s\" takes more than the 15 deg of tilt that the autopilot gives, on this radius and with this drag; allowed: up to 5.9 m/s", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "drag": {"lateral": "0 N s/m"}}, "mission": {"type": "circle", "radius": "50 cm"}}]})", "/fleet/0/mission/speed", "allowed: up to 1.14 m/s", false},
    {R"({"fleet": [{"control_period": "100 ms"}]})", "/fleet/0/control_period", "\"100 ms\" lets the motors stop between two commands; allowed: less than motor_timeout, here 100 ms", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "collision": {"behaviour": "explode"}}}]})", "/fleet/0/vehicle/collision/behaviour", "\"explode\" is not known; allowed: stop, bounce, crash", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "collision": {"restitution": 1.5}}}]})", "/fleet/0/vehicle/collision/restitution", "1.5 is out of range; allowed: a number 0.0 ... 1.0", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"ultrasonic": {"beam": "180 deg"}}}}]})", "/fleet/0/vehicle/sensors/ultrasonic/beam", "\"180 deg\" is out of range; allowed: 1 deg ... 170 deg", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"ultrasonic": {"direction": "north"}}}}]})", "/fleet/0/vehicle/sensors/ultrasonic/direction", "\"north\" is not known; allowed: down, up, forward, backward, left, right", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"lidar": {"rays": 2048, "elevations": ["0 deg", "1 deg", "2 deg"]}}}}]})", "/fleet/0/vehicle/sensors/lidar/rays", "2048 in each of 3 rows are too many; allowed: 4096 in all", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"lidar": {"elevations": []}}}}]})", "/fleet/0/vehicle/sensors/lidar/elevations", "has 0 elements; allowed: 1 ... 128 angles", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"gnss": {"mask": "90 deg"}}}}]})", "/fleet/0/vehicle/sensors/gnss/mask", "\"90 deg\" is out of range; allowed: 0 deg ... 60 deg", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"gnss": "on"}}}]})", "/fleet/0/vehicle/sensors/gnss", "rate, mask, drift, correlation_time, noise and rate_noise", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"width": 8}}}}]})", "/fleet/0/vehicle/sensors/camera/width", "8 is out of range or not whole; allowed: a whole number 16 ... 1920", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"rate": "100 Hz"}}}}]})", "/fleet/0/vehicle/sensors/camera/rate", "\"100 Hz\" is out of range; allowed: 1 Hz ... 60 Hz", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"field": "180 deg"}}}}]})", "/fleet/0/vehicle/sensors/camera/field", "\"180 deg\" is out of range; allowed: 10 deg ... 150 deg", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"direction": "up"}}}}]})", "/fleet/0/vehicle/sensors/camera/direction", "\"up\" is not known; allowed: forward, down, or an object with roll, pitch and yaw", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"direction": {"tilt": "3 deg"}}}}}]})", "/fleet/0/vehicle/sensors/camera/direction/tilt", "is not a known key; allowed: roll, pitch, yaw", true},
    {R"({"fleet": [{"vehicle": {"model": "x4", "sensors": {"camera": {"offset": ["0 m", "3 m", "0 m"]}}}}]})", "/fleet/0/vehicle/sensors/camera/offset", "is further than 2 m from the vehicle's position", false},
    {R"({"fleet": [{"vehicle": {"model": "x4", "motor_timeout": "2 ms"}}]})", "/fleet/0/control_period", "\"5 ms\" lets the motors stop between two commands; allowed: less than motor_timeout, here 2 ms", false},
    {R"({"fleet": [{"neighbours": {"source": "telepathy"}}]})", "/fleet/0/neighbours/source", "allowed: beacons, motion-capture", true},
    {R"({"fleet": [{"neighbours": {"beacon_period": "2 s", "timeout": "1 s"}}]})", "/fleet/0/neighbours/timeout", "is shorter than beacon_period; allowed: 2 s ... 60 s", false},
    {R"({"fleet": [{"neighbours": {"port": 80}}]})", "/fleet/0/neighbours/port", "allowed: a whole number 1024 ... 65535", true},
    {R"({"fleet": [{"neighbours": {"port": 47000}}]})", "/fleet/0/neighbours/port", "47000 is taken by /ground_station/telemetry_port", false},
    {R"({"fleet": [{"command": "ping gcs"}]})", "/fleet/0/command", "is one text; allowed: none, or an array of the program and its arguments", true},
    {R"({"fleet": [{"agent": "hover"}]})", "/fleet/0/agent", "is one text; allowed: cuscus-agent, or an array of the program and its arguments", true},
    {R"({"fleet": [{"agent": ["hover"], "autopilot": false}]})", "/fleet/0/agent", "needs \"autopilot\": true; allowed: cuscus-agent", false},
    {R"({"fleet": [{"agent": ["hover", "{gsc_ip}"]}]})", "/fleet/0/agent/1", "did you mean {gcs_ip}?", false},
    {R"({"fleet": [{"command": []}]})", "/fleet/0/command", "is empty; allowed: none, or at least the program", true},
    {R"({"fleet": [{"command": ["ping", 3]}]})", "/fleet/0/command/1", "3 is a number; allowed: a text", true},
    {R"({"fleet": [{"command": ["../../bin/sh"]}]})", "/fleet/0/command/0", "leaves the scenario's folder", false},
    {R"({"fleet": [{"command": ["./a/../../b"]}]})", "/fleet/0/command/0", "leaves the scenario's folder", false},
    {R"({"fleet": [{"command": ["ping", "{gsc_ip}"]}]})", "/fleet/0/command/1", "{gsc_ip} is not a known placeholder; did you mean {gcs_ip}?", false},
    {R"({"fleet": [{"command": ["ping", "{ip:uav7}"]}]})", "/fleet/0/command/1", "there is no \"uav7\"", false},
    {R"({"fleet": [{"command": ["ping", "{gcs_ip}"]}], "ground_station": {"enabled": false}})", "/fleet/0/command/1", "which has no ground station", false},
    {R"({"fleet": [{"command": ["awk", "{print"]}]})", "/fleet/0/command/1", "has a { without a } after it; write {{ for a brace", false},
    {R"({"fleet": [{"capabilities": ["cap_sys_admin"]}]})", "/fleet/0/capabilities/0", "\"cap_sys_admin\" cannot be given", true},
    {R"({"fleet": [{"environment": {"A=B": "1"}}]})", "/fleet/0/environment/A=B", "is not a variable that can be set", false},
    {R"({"fleet": [{"environment": {"CUSCUS_CONTROL_FD": "3"}}]})", "/fleet/0/environment/CUSCUS_CONTROL_FD", "not CUSCUS_...", false},
    {R"({"fleet": [{"environment": {"A": 1}}]})", "/fleet/0/environment/A", "1 is a number; allowed: a text", true},
    {R"({"fleet": [{"on_exit": "restart"}]})", "/fleet/0/on_exit", "allowed: fail, mark, ignore", true},
    {R"({"ground_station": {"page": {"port": 0}}})", "/ground_station/page/port", "allowed: a whole number 1 ... 65535", true},
    {R"({"ground_station": {"page": "8080"}})", "/ground_station/page", "allowed: none, or an object with port", true},
    {R"({"ground_station": {"position": ["0 m", "0 m", "0 km/h"]}})", "/ground_station/position/2", "has the unit \"km/h\"; allowed: a length", true},
    {R"({"record": {"metrics_period": "1 ms"}})", "/record/metrics_period", "allowed: 10 ms ... 60 s", false},
    {R"({"record": {"videos": true}})", "/record/videos", "is not a known key; allowed: frames, receptions, captures, failed_receptions, snap_length, metrics_period", true},
    {R"({"record": {"captures": "uav0"}})", "/record/captures", "\"uav0\"; allowed: true, false, or an array of 1 ... 1000 node names", true},
    {R"({"record": {"captures": []}})", "/record/captures", "allowed: true, false, or an array of 1 ... 1000 node names", true},
    {R"({"record": {"captures": ["uav0", "uva1"]}, "fleet": [{"count": 2}]})", "/record/captures/1", "\"uva1\" is no node; did you mean \"uav1\"? allowed: names of nodes, such as \"gcs\"", false},
    {R"({"record": {"snap_length": 32}})", "/record/snap_length", "allowed: a whole number 64 ... 65535", true},
    {R"({"record": {"snap_length": "all"}})", "/record/snap_length", "\"all\"; allowed: none, or a whole number of bytes 64 ... 65535", true},
};
// clang-format on

TEST_CASE("Every bad input is refused by file, path, value and what is allowed") {
  for (const BadInput& input : kTable) {
    CAPTURE(input.patch);
    json document = json::parse(R"({"name": "t", "fleet": [{}]})");
    document.merge_patch(json::parse(input.patch));

    const ScenarioError error = error_of(document.dump());

    CHECK(error.problems().size() == 1);
    CHECK(error.problems().front().source == kSource);
    CHECK(error.problems().front().path == input.path);
    CHECK_THAT(error.problems().front().message, Catch::Contains(input.fragment));
    CHECK_THAT(error.what(), Catch::StartsWith(std::string{kSource} + ": " + input.path + ": "));
  }
}

TEST_CASE("The schema refuses what an editor can know to be wrong") {
  for (const BadInput& input : kTable) {
    CAPTURE(input.patch);
    json document = json::parse(R"({"name": "t", "fleet": [{}]})");
    document.merge_patch(json::parse(input.patch));
    Problems problems{kSource, {}};

    check_against_schema(document, problems);

    CHECK(problems.empty() == !input.schema_rejects);
  }
}

TEST_CASE("A text that is not strict JSON is refused with its line") {
  const std::array<std::array<const char*, 2>, 9> table{{
      {"", "unexpected end of input"},
      {"{\n\"name\": }", "line 2, column 9"},
      {"{\"name\": \"a\",}", "line 1"},
      {"{} // comment", "line 1"},
      {"{\"seed\": NaN}", "invalid literal"},
      {"{\"seed\": Infinity}", "invalid literal"},
      {"{\"seed\": 1e999}", "number overflow"},
      {"{\"name\": \"\xff\"}", "ill-formed UTF-8"},
      {"{\"seed\": 01}", "line 1"},
  }};
  for (const auto& [text, fragment] : table) {
    CAPTURE(text);
    const ScenarioError error = error_of(text);

    CHECK(error.problems().front().path.empty());
    CHECK_THAT(error.what(),
               Catch::StartsWith("flight.json: is not JSON: ") && Catch::Contains(fragment));
  }
}

TEST_CASE("A document that is not an object is refused") {
  CHECK_THAT(error_of("[]").what(), Catch::Contains("allowed: an object"));
  CHECK_THAT(error_of("null").what(), Catch::Contains("null is null; allowed: an object"));
}

TEST_CASE("Control characters of a key do not reach the terminal") {
  const ScenarioError error =
      error_of(R"({"name": "t", "fleet": [{}], "\u001b[2Jevil\u0007": "\u001b[2J"})");

  CHECK(error.problems().front().path == "/?[2Jevil?");
  CHECK(std::string{error.what()}.find('\x1b') == std::string::npos);
}

TEST_CASE("A key given twice is refused with its path") {
  const ScenarioError error = error_of(
      R"({"name": "t", "fleet": [{}, {"start": {"layout": "grid", "heading": "0 deg", "layout": "line"}}]})");

  CHECK(error.problems().front().path == "/fleet/1/start/layout");
  CHECK_THAT(error.what(), Catch::Contains("is given twice"));
}

TEST_CASE("The same key in two objects is no repetition") {
  CHECK_NOTHROW(parse_scenario(
      R"({"name": "t", "fleet": [{"name": "a"}, {"name": "b", "start":
          {"layout": "grid", "centre": ["9 m", "0 m", "0 m"]}}]})",
      kSource, "/"));
}

TEST_CASE("What only our autopilot needs is not asked of what flies without it") {
  CHECK_NOTHROW(parse_scenario(
      R"({"name": "t", "world": {"motion_capture": {"rate": "1 Hz"}}, "fleet": [
          {"vehicle": {"model": "fixed"}, "control_period": "1 s", "start":
              {"layout": "grid", "centre": ["0 m", "0 m", "10 m"]}},
          {"name": "on-ground", "autopilot": false, "control_period": "1 s"},
          {"name": "own", "agent": ["./fly"], "control_period": "1 s",
           "mission": {"type": "circle", "radius": "5 m", "speed": "30 m/s"}, "start":
              {"layout": "grid", "centre": ["9 m", "0 m", "0 m"]}}]})",
      kSource, "/"));
}

TEST_CASE("Nesting is refused from 65 levels on, however deep") {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };

  CHECK_THAT(error_of(nested(64)).what(), !Catch::Contains("nested"));
  CHECK_THAT(error_of(nested(65)).what(), Catch::Contains("nested more than 64 levels deep"));
  CHECK_THAT(error_of(nested(1'000'000)).what(), Catch::Contains("nested more than 64"));
}

TEST_CASE("A document above 10 MB is refused before it is read") {
  const std::string text(10 * 1024 * 1024 + 1, ' ');

  CHECK_THAT(error_of(text).what(), Catch::Contains("is 10485761 B long; allowed: up to 10485760"));
}

TEST_CASE("All problems are listed at once, twenty of them") {
  json document = json::parse(R"({"name": "t", "fleet": [{}]})");
  for (int i = 0; i < 25; ++i) {
    document["unknown" + std::to_string(i)] = i;
  }

  const ScenarioError error = error_of(document.dump());

  const std::string text = error.what();
  CHECK(error.problems().size() == 25);
  CHECK(std::count(text.begin(), text.end(), '\n') == 20);
  CHECK_THAT(text, Catch::EndsWith("and 5 more"));
}

TEST_CASE("A problem with what an option set names the option instead of the file") {
  const std::vector<Override> overrides{parse_override("radio.data_rate=7 Mb/s")};

  const ScenarioError error = error_of(R"({"name": "t", "fleet": [{}]})", overrides);

  CHECK_THAT(error.what(), Catch::StartsWith("--set radio.data_rate=7 Mb/s: /radio/data_rate: "));
}

TEST_CASE("An option that leads nowhere is refused by its name") {
  const std::string text = R"({"name": "t", "seed": 1, "fleet": [{}]})";
  const auto error_with = [&](const char* argument) {
    const std::vector<Override> overrides{parse_override(argument)};
    return std::string{error_of(text, overrides).what()};
  };

  CHECK_THAT(
      error_with("fleet.7.count=5"),
      Catch::Contains("--set fleet.7.count=5: /fleet: has no element \"7\"; allowed: 0 ... 0"));
  CHECK_THAT(error_with("fleet.x.count=5"), Catch::Contains("has no element \"x\""));
  CHECK_THAT(error_with("seed.value=5"), Catch::Contains("/seed: is 1 in the file"));
  CHECK_THAT(error_with("radio..slot=5"), Catch::Contains("has an empty part in its path"));
  CHECK_THAT(error_with("rdio.slot=9 us"), Catch::Contains("did you mean \"radio\"?"));
  CHECK_THROWS_WITH(parse_override("radio"), Catch::Contains("is not PATH=VALUE"));
  CHECK_THROWS_WITH(parse_override("=5"), Catch::Contains("is not PATH=VALUE"));
}

}  // namespace
}  // namespace cuscus::scenario
