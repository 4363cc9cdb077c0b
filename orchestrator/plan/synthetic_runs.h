#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/scenario/scenario.h"
#include "proto/synthetic.pb.h"

/// What `cuscus air` has simulated: a scenario's radio and start positions, other traffic.
namespace cuscus::orchestrator {

struct SyntheticRequest {
  std::string traffic{"beacons"};  ///< "beacons", "saturated", "flow", "ping"
  bool unicast{false};             ///< beacons, saturated: to the next node each.
  std::uint32_t payload_bytes{64};
  /// Of beacons and pings 50 ms; of a flow as fast as its MAC takes them.
  std::optional<scenario::Duration> period{};
  scenario::Duration jitter{0};       ///< Of every beacon, uniform.
  std::optional<std::string> from{};  ///< Flow and ping; else the first node.
  std::optional<std::string> to{};    ///< Flow and ping; else the second node.
  scenario::Duration duration{std::chrono::seconds{10}};
  std::uint32_t seeds{1};  ///< The scenario's, and the ones that follow it.
};

/// One run per scenario and seed, in this order; the scenarios are variants of one.
/// @throws std::invalid_argument naming the option, its value and what is allowed.
[[nodiscard]] proto::SyntheticRuns synthetic_runs(const SyntheticRequest& request,
                                                  std::span<const scenario::Scenario> scenarios);

/// Size of the first group of the fleet with which `scenario` has `nodes` radio nodes.
/// @throws std::invalid_argument when there is none.
[[nodiscard]] std::uint32_t first_group_size(const scenario::Scenario& scenario,
                                             std::uint32_t nodes);

}  // namespace cuscus::orchestrator
