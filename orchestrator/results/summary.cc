#include "orchestrator/results/summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "orchestrator/results/report_json.h"

namespace cuscus::orchestrator {
namespace {

using Json = nlohmann::ordered_json;

Json error_json(const std::optional<FormationErrorSummary>& error) {
  if (!error) {
    return nullptr;
  }
  return {{"samples", error->samples},
          {"mean_m", error->mean_m},
          {"p50_m", error->p50_m},
          {"p95_m", error->p95_m},
          {"max_m", error->max_m}};
}

Json program_json(const ProgramOutcome& outcome) {
  return {{"kind", name_of(outcome.kind)},
          {"program", outcome.program},
          {"exit_code", outcome.exit_code ? Json(*outcome.exit_code) : Json(nullptr)},
          {"signal", outcome.signal_number ? Json(*outcome.signal_number) : Json(nullptr)},
          {"error", outcome.error.empty() ? Json(nullptr) : Json(outcome.error)},
          {"ended_at_s", outcome.ended_at ? Json(to_seconds(*outcome.ended_at)) : Json(nullptr)}};
}

Json node_json(const NodeOutcome& node) {
  Json programs = Json::array();
  for (const ProgramOutcome& program : node.programs) {
    programs.push_back(program_json(program));
  }
  return {{"index", node.index},
          {"name", node.name},
          {"role", name_of(node.role)},
          {"radio", node.radio ? json_of(*node.radio) : Json(nullptr)},
          {"emulator", node.emulator ? json_of(*node.emulator) : Json(nullptr)},
          {"tap_dropped", node.tap_dropped ? Json(*node.tap_dropped) : Json(nullptr)},
          {"commands", node.commands ? json_of(*node.commands) : Json(nullptr)},
          {"collisions", node.collisions ? json_of(*node.collisions) : Json(nullptr)},
          {"agent", node.agent ? json_of(*node.agent) : Json(nullptr)},
          {"formation_error", error_json(node.formation_error)},
          {"camera", node.camera ? json_of(*node.camera) : Json(nullptr)},
          {"programs", programs}};
}

/// Sums over the nodes that have a tally.
Json radio_total(const std::vector<NodeOutcome>& nodes) {
  Json total = json_of(shm::RadioTally{});
  for (const NodeOutcome& node : nodes) {
    if (node.radio) {
      const Json tally = json_of(*node.radio);
      for (const auto& [key, count] : tally.items()) {
        total[key] = total[key].get<std::uint64_t>() + count.get<std::uint64_t>();
      }
    }
  }
  return total;
}

}  // namespace

std::optional<FormationErrorSummary> summarize_errors(std::span<const double> errors_m) {
  std::vector<double> sorted_m;
  std::copy_if(errors_m.begin(), errors_m.end(), std::back_inserter(sorted_m),
               [](double error_m) { return std::isfinite(error_m); });
  if (sorted_m.empty()) {
    return std::nullopt;
  }
  std::sort(sorted_m.begin(), sorted_m.end());
  const double count = static_cast<double>(sorted_m.size());
  const auto quantile = [&](double share) {
    const double rank = std::max(1.0, std::ceil(share * count));
    return sorted_m[static_cast<std::size_t>(rank) - 1];
  };
  return FormationErrorSummary{
      .samples = sorted_m.size(),
      .mean_m = std::accumulate(sorted_m.begin(), sorted_m.end(), 0.0) / count,
      .p50_m = quantile(0.5),
      .p95_m = quantile(0.95),
      .max_m = sorted_m.back()};
}

Json to_json(const RunOutcome& run, const Fidelity& fidelity) {
  Json nodes = Json::array();
  for (const NodeOutcome& node : run.nodes) {
    nodes.push_back(node_json(node));
  }
  return {{"run_id", run.run_id},
          {"scenario", run.scenario_name},
          {"seed", run.seed},
          {"versions", Json(run.versions)},
          {"started_utc", run.started_utc},
          {"planned_s", to_seconds(run.planned)},
          {"simulated_s", to_seconds(run.simulated)},
          {"end_reason", run.end_reason},
          {"exit_code", run.exit_code},
          {"verdict", name_of(fidelity.verdict)},
          {"verdict_reasons", fidelity.reasons},
          {"metrics_rows_dropped", run.metrics_rows_dropped},
          {"formation_error", error_json(run.formation_error)},
          {"radio_total", radio_total(run.nodes)},
          {"ground_station", run.ground_station ? json_of(*run.ground_station) : Json(nullptr)},
          {"cameras", run.cameras ? json_of(*run.cameras) : Json(nullptr)},
          {"nodes", nodes}};
}

}  // namespace cuscus::orchestrator
