#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "orchestrator/plan/plan.h"
#include "orchestrator/results/fidelity.h"
#include "proto/report.pb.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::orchestrator {

/// How a program ended.
struct ProgramOutcome {
  ProgramKind kind{ProgramKind::kCommand};
  std::string program;                         ///< arguments[0]
  std::optional<int> exit_code;                ///< When it exited by itself or after SIGTERM.
  std::optional<int> signal_number;            ///< When a signal ended it.
  std::string error;                           ///< Why it could not be started, else empty.
  std::optional<SimClock::duration> ended_at;  ///< SimTime, when it ended before the run did.
};

/// Quantiles of the distances between where a UAV was and where its formation wanted it.
struct FormationErrorSummary {
  std::uint64_t samples{};
  double mean_m{};
  double p50_m{};
  double p95_m{};
  double max_m{};
};

/// Of `errors_m`, NaN left out; nothing when none is left. Quantile q is the smallest value that at
/// least the share q of the samples does not exceed.
[[nodiscard]] std::optional<FormationErrorSummary> summarize_errors(
    std::span<const double> errors_m);

/// What is known of a node at the end of a run.
struct NodeOutcome {
  std::uint32_t index{};
  std::string name;
  NodeRole role{NodeRole::kUav};
  std::optional<shm::RadioTally> radio;
  std::optional<proto::NodeServiceReport> emulator;
  std::optional<std::uint64_t> tap_dropped;  ///< Frames that the kernel dropped on its TAP.
  std::optional<shm::CommandTally> commands;
  std::optional<proto::CollisionTally> collisions;  ///< Of a vehicle.
  std::optional<proto::AgentReport> agent;
  std::optional<FormationErrorSummary> formation_error;
  std::vector<ProgramOutcome> programs;
  std::optional<proto::CameraTally> camera{};  ///< Of a vehicle with a camera.
};

/// The whole run.
struct RunOutcome {
  std::string run_id;
  std::string scenario_name;
  std::uint64_t seed{};
  std::string started_utc;         ///< "2026-01-31T12:00:00Z"
  SimClock::duration planned{};    ///< The scenario's duration.
  SimClock::duration simulated{};  ///< How far it got.
  std::string end_reason;          ///< "duration reached", "SIGINT", "netsim: killed by ..."
  /// What ran, by name: "cuscus", "kernel".
  std::map<std::string, std::string> versions;
  int exit_code{};                       ///< Of `cuscus`.
  std::uint64_t metrics_rows_dropped{};  ///< That metrics.csv should have and has not.
  std::vector<NodeOutcome> nodes;
  std::optional<FormationErrorSummary> formation_error;  ///< Of all UAVs together.
  std::optional<proto::GroundStationReport> ground_station;
  std::optional<proto::CameraReport> cameras{};
};

/// Content of summary.json.
[[nodiscard]] nlohmann::ordered_json to_json(const RunOutcome& run, const Fidelity& fidelity);

}  // namespace cuscus::orchestrator
