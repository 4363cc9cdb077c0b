#include "orchestrator/app/sampler.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace cuscus::orchestrator {

Sampler::Sampler(const Plan& plan, const LiveRun& run, MetricsWriter& metrics)
    : plan_{plan},
      run_{run},
      metrics_{metrics},
      states_(plan.nodes.size()),
      errors_m_(plan.nodes.size()),
      settled_errors_m_(plan.nodes.size()) {
  for (const auto& node : plan.nodes) {
    // The member in slot 0 stands for its formation.
    if (!node.agent || !node.agent->has_circle() || node.agent->slot() != 0) {
      continue;
    }
    const auto& circle = node.agent->circle();
    const auto& centre = circle.p_wc_centre_m();
    formations_.push_back(
        {.reference = {{.p_WC_m = {centre.x(), centre.y(), centre.z()},
                        .radius_m = circle.radius_m()},
                       circle.speed_mps()},
         .nodes = {node.agent->slot_nodes().begin(), node.agent->slot_nodes().end()}});
  }
}

void Sampler::sample(double sim_time_s) {
  const auto& fleet = run_.memories().fleet_reader();
  const auto& radio = run_.memories().radio_reader();
  for (const auto& node : plan_.nodes) {
    states_[node.index] = fleet->state(node.index);
    errors_m_[node.index].reset();
  }
  const SimTime time = sim_time(static_cast<std::int64_t>(sim_time_s * 1e9));
  for (auto& formation : formations_) {
    measure(formation, time);
  }
  const bool settled = sim_time_s >= to_seconds(plan_.duration) / 2.0;
  for (const auto& node : plan_.nodes) {
    const auto& error_m = errors_m_[node.index];
    if (settled && error_m) {
      settled_errors_m_[node.index].push_back(*error_m);
    }
    metrics_.add({.time = time,
                  .node = node.name,
                  .motion = states_[node.index],
                  .formation_error_m = error_m,
                  .flight_state = run_.crew()->state_of(node.index),
                  .radio = radio->tally(node.index)});
  }
  metrics_.flush();
  if (const auto error = metrics_.take_error()) {
    spdlog::error("{}", *error);
  }
}

void Sampler::measure(Formation& formation, SimTime now) {
  std::vector<FormationMember> members;
  for (std::uint32_t slot = 0; slot < formation.nodes.size(); ++slot) {
    const auto& state = states_[formation.nodes[slot]];
    if (!state) {
      return;  // being written at every attempt: this sample has no error
    }
    members.push_back(
        {.p_WB_m = {state->p_WB_m[0], state->p_WB_m[1], state->p_WB_m[2]}, .slot = slot});
  }
  const auto errors_m = formation.reference.errors_m(now, members);
  for (std::size_t slot = 0; slot < members.size(); ++slot) {
    errors_m_[formation.nodes[slot]] = errors_m[slot];
  }
}

std::optional<FormationErrorSummary> Sampler::formation_error(std::uint32_t node) const {
  return summarize_errors(settled_errors_m_[node]);
}

std::optional<FormationErrorSummary> Sampler::formation_error() const {
  std::vector<double> all;
  for (const auto& errors_m : settled_errors_m_) {
    all.insert(all.end(), errors_m.begin(), errors_m.end());
  }
  return summarize_errors(all);
}

}  // namespace cuscus::orchestrator
