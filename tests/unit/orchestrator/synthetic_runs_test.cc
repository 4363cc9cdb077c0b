#include "orchestrator/plan/synthetic_runs.h"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace cuscus::orchestrator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Three fixed nodes on a line of 10 m, and the ground station.
scenario::Scenario line() {
  return scenario::parse_scenario(
      R"({"name": "line", "seed": 7, "radio": {"data_rate": "54 Mb/s"},
          "fleet": [{"name": "mast", "count": 3, "vehicle": {"model": "fixed"},
                     "start": {"layout": "line", "spacing": "10 m", "heading": "90 deg"}}]})",
      "line.json", "/scenarios");
}

proto::SyntheticRuns runs_of(const SyntheticRequest& request) {
  const std::vector<scenario::Scenario> scenarios{line()};
  return synthetic_runs(request, scenarios);
}

/// What is wrong with `request`.
std::string refusal(const SyntheticRequest& request) {
  try {
    static_cast<void>(runs_of(request));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("a synthetic run has the scenario's radio, start positions and headings") {
  const proto::SyntheticRuns runs = runs_of({});

  CHECK(runs.scenario_name() == "line");
  REQUIRE(runs.runs_size() == 1);
  const proto::SyntheticRun& run = runs.runs(0);
  CHECK(run.radio().data_rate_kbps() == 54'000);
  CHECK(run.radio().seed() == 7);
  REQUIRE(run.radio().nodes_size() == 4);
  REQUIRE(run.nodes_size() == 4);
  CHECK(run.nodes(1).p_wb_m().x() - run.nodes(0).p_wb_m().x() == Approx(10.0));
  CHECK(run.nodes(0).yaw_rad() == Approx(1.5707963));
  CHECK(run.nodes(3).p_wb_m().z() == 1.0);  // the ground station
  CHECK(run.traffic().kind() == "beacons");
  CHECK_FALSE(run.traffic().unicast());
  CHECK(run.traffic().period_ns() == 50'000'000);
  CHECK(run.duration_ns() == 10'000'000'000);
}

TEST_CASE("there is a run for every scenario and seed, scenarios first") {
  const std::vector<scenario::Scenario> scenarios{line(), line()};

  const proto::SyntheticRuns runs = synthetic_runs({.seeds = 3}, scenarios);

  REQUIRE(runs.runs_size() == 6);
  CHECK(runs.runs(0).radio().seed() == 7);
  CHECK(runs.runs(2).radio().seed() == 9);
  CHECK(runs.runs(3).radio().seed() == 7);
}

TEST_CASE("flows and pings go between the first two nodes, or those named") {
  const proto::SyntheticRun flow = runs_of({.traffic = "flow"}).runs(0);
  CHECK(flow.traffic().from() == 0);
  CHECK(flow.traffic().to() == 1);
  CHECK(flow.traffic().unicast());
  CHECK(flow.traffic().period_ns() == 0);

  const proto::SyntheticRun ping =
      runs_of({.traffic = "ping", .from = "gcs", .to = "mast2"}).runs(0);
  CHECK(ping.traffic().from() == 3);
  CHECK(ping.traffic().to() == 2);
  CHECK(ping.traffic().period_ns() == 50'000'000);
}

TEST_CASE("the first group makes up the number of nodes that is asked for") {
  CHECK(first_group_size(line(), 2) == 1);  // and the ground station
  CHECK(first_group_size(line(), 50) == 49);
  CHECK_THROWS_WITH(first_group_size(line(), 1), Catch::Contains("--nodes 1: allowed: 2 or more"));
}

TEST_CASE("what cannot be simulated is refused with what is allowed") {
  CHECK(refusal({.traffic = "flood"}) ==
        "--traffic flood: allowed: beacons, saturated, flow, ping");
  CHECK(refusal({.payload_bytes = 0}) ==
        "--payload 0: allowed: 1 ... 1472 bytes of UDP, what fits the network's MTU");
  CHECK(refusal({.payload_bytes = 1473}).starts_with("--payload 1473: allowed: 1 ... 1472"));
  CHECK(refusal({.payload_bytes = 1472}) == "accepted");
  CHECK(refusal({.period = microseconds{99}}).starts_with("--period 99 us: allowed: 100 us ..."));
  CHECK(refusal({.duration = milliseconds{9}}).starts_with("--duration 9 ms: allowed: 10 ms ..."));
  CHECK(refusal({.jitter = milliseconds{51}}).starts_with("--jitter 51 ms: allowed: 0"));
  CHECK(refusal({.seeds = 0}) == "--seeds 0: allowed: 1 ... 1000");
  CHECK(refusal({.traffic = "flow", .from = "uav9"}) ==
        "--from uav9: there is no such node; allowed: mast0 ... gcs");
  CHECK(refusal({.traffic = "ping", .from = "mast1"}) ==
        "traffic ping needs two nodes; both ends are mast1");
  CHECK(refusal({.to = "mast1"}) ==
        "--from and --to go with --traffic flow or ping, not with beacons");
  CHECK(refusal({.traffic = "flow", .unicast = true}) ==
        "--unicast goes with --traffic beacons or saturated, not with flow");
  CHECK(refusal({.traffic = "saturated", .period = seconds{1}}) ==
        "--period does not go with --traffic saturated, which sends as fast as it can");
  CHECK(refusal({.traffic = "ping", .jitter = milliseconds{1}}) ==
        "--jitter goes with --traffic beacons, not with ping");
}

}  // namespace
}  // namespace cuscus::orchestrator
