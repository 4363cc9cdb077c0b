#include "orchestrator/plan/synthetic_runs.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "common/scenario/units.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {
namespace {

using scenario::Duration;
using std::chrono::milliseconds;

constexpr Duration kWarmUp = milliseconds{500};
constexpr Duration kDefaultPeriod = milliseconds{50};
constexpr Duration kLongestDuration = std::chrono::hours{24};
constexpr Duration kLongestPeriod = std::chrono::hours{1};
constexpr std::uint32_t kMostSeeds = 1'000;
constexpr std::uint32_t kIpAndUdpBytes = 28;
constexpr std::array<std::string_view, 4> kTraffic{"beacons", "saturated", "flow", "ping"};

void require(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{rule};
  }
}

std::string time_text(Duration duration) {
  return scenario::format_quantity(static_cast<double>(duration.count()), scenario::kTime);
}

void require_within(const char* option, Duration value, Duration least, Duration most) {
  require(value >= least && value <= most,
          fmt::format("{} {}: allowed: {} ... {}", option, time_text(value), time_text(least),
                      time_text(most)));
}

bool between_two(const SyntheticRequest& request) {
  return request.traffic == "flow" || request.traffic == "ping";
}

void check(const SyntheticRequest& request) {
  require(std::find(kTraffic.begin(), kTraffic.end(), request.traffic) != kTraffic.end(),
          fmt::format("--traffic {}: allowed: {}", request.traffic, fmt::join(kTraffic, ", ")));
  require(
      (!request.from && !request.to) || between_two(request),
      fmt::format("--from and --to go with --traffic flow or ping, not with {}", request.traffic));
  require(!request.unicast || !between_two(request),
          fmt::format("--unicast goes with --traffic beacons or saturated, not with {}",
                      request.traffic));
  require(request.traffic == "beacons" || request.jitter == Duration::zero(),
          fmt::format("--jitter goes with --traffic beacons, not with {}", request.traffic));
  require(request.traffic != "saturated" || !request.period,
          "--period does not go with --traffic saturated, which sends as fast as it can");
  require_within("--duration", request.duration, milliseconds{10}, kLongestDuration);
  if (request.period) {
    require_within("--period", *request.period, std::chrono::microseconds{100}, kLongestPeriod);
  }
  require_within("--jitter", request.jitter, Duration::zero(),
                 request.period.value_or(kDefaultPeriod));
  require(request.seeds >= 1 && request.seeds <= kMostSeeds,
          fmt::format("--seeds {}: allowed: 1 ... {}", request.seeds, kMostSeeds));
}

std::uint32_t node_called(const Plan& plan, const char* option, const std::string& name) {
  for (const NodePlan& node : plan.nodes) {
    if (node.name == name) {
      return node.index;
    }
  }
  throw std::invalid_argument{fmt::format("{} {}: there is no such node; allowed: {} ... {}",
                                          option, name, plan.nodes.front().name,
                                          plan.nodes.back().name)};
}

proto::SyntheticTraffic traffic_of(const SyntheticRequest& request, const Plan& plan) {
  proto::SyntheticTraffic traffic;
  traffic.set_kind(request.traffic);
  traffic.set_unicast(request.unicast || between_two(request));
  traffic.set_udp_payload_bytes(request.payload_bytes);
  const Duration period =
      request.period.value_or(request.traffic == "flow" ? Duration::zero() : kDefaultPeriod);
  traffic.set_period_ns(period.count());
  traffic.set_jitter_ns(request.jitter.count());
  if (between_two(request)) {
    traffic.set_from(request.from ? node_called(plan, "--from", *request.from) : 0);
    traffic.set_to(request.to ? node_called(plan, "--to", *request.to) : 1);
    require(traffic.from() != traffic.to(),
            fmt::format("traffic {} needs two nodes; both ends are {}", request.traffic,
                        plan.nodes[traffic.from()].name));
  }
  return traffic;
}

proto::SyntheticRun run_of(const SyntheticRequest& request, const Plan& plan) {
  proto::SyntheticRun run;
  *run.mutable_radio() = plan.radio;
  *run.mutable_traffic() = traffic_of(request, plan);
  for (const proto::WorldNode& node : plan.world.nodes()) {
    proto::SyntheticNode& placed = *run.add_nodes();
    *placed.mutable_p_wb_m() = node.p_wb_start_m();
    placed.set_yaw_rad(node.yaw_start_rad());
  }
  run.set_warm_up_ns(kWarmUp.count());
  run.set_duration_ns(request.duration.count());
  return run;
}

}  // namespace

std::uint32_t first_group_size(const scenario::Scenario& scenario, std::uint32_t nodes) {
  const std::uint32_t others = scenario.node_count() - scenario.fleet.front().count;
  require(nodes > others && nodes >= 2,
          fmt::format("--nodes {}: allowed: {} or more, as one node of '{}' and {} others fly",
                      nodes, std::max(others + 1, 2U), scenario.fleet.front().name, others));
  return nodes - others;
}

proto::SyntheticRuns synthetic_runs(const SyntheticRequest& request,
                                    std::span<const scenario::Scenario> scenarios) {
  check(request);
  proto::SyntheticRuns runs;
  for (const scenario::Scenario& scenario : scenarios) {
    const Plan plan = make_plan(scenario);
    require(plan.nodes.size() >= 2,
            fmt::format("scenario '{}' has one radio node; allowed: two or more", scenario.name));
    const std::uint32_t most_bytes = scenario.network.mtu_bytes - kIpAndUdpBytes;
    require(request.payload_bytes >= 1 && request.payload_bytes <= most_bytes,
            fmt::format("--payload {}: allowed: 1 ... {} bytes of UDP, what fits the network's MTU",
                        request.payload_bytes, most_bytes));
    runs.set_scenario_name(scenario.name);
    for (std::uint32_t seed = 0; seed < request.seeds; ++seed) {
      proto::SyntheticRun& run = *runs.add_runs();
      run = run_of(request, plan);
      run.mutable_radio()->set_seed(scenario.seed + seed);
    }
  }
  return runs;
}

}  // namespace cuscus::orchestrator
