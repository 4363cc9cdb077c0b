#include "orchestrator/app/findings.h"

#include <fmt/core.h>
#include <sys/utsname.h>

#include <csignal>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "common/ipc/duration_summary.h"

namespace cuscus::orchestrator {
namespace {

const proto::Report* report_of(const Service* service) {
  return service != nullptr && service->component().report() ? &*service->component().report()
                                                             : nullptr;
}

const proto::Report* report_of(const NodeProgram& program) {
  return program.component && program.component->report() ? &*program.component->report() : nullptr;
}

ProgramOutcome outcome_of(const NodeProgram& program) {
  ProgramOutcome outcome{.kind = program.plan->kind,
                         .program = program.plan->arguments.at(0),
                         .exit_code = {},
                         .signal_number = {},
                         .error = program.error,
                         .ended_at = {}};
  if (program.status && program.status->signal_number != 0) {
    outcome.signal_number = program.status->signal_number;
  } else if (program.status) {
    outcome.exit_code = program.status->exit_code;
  }
  if (program.has_ended() && program.ended_early) {
    outcome.ended_at = SimClock::duration{static_cast<std::int64_t>(program.ended_at_s * 1e9)};
  }
  return outcome;
}

/// What netsim has reported of a node, if it came to that.
std::optional<proto::NodeServiceReport> service_of(std::uint32_t node, const LiveRun& run) {
  const auto* const report = report_of(run.netsim());
  if (report == nullptr || std::cmp_greater_equal(node, report->radio().nodes_size())) {
    return std::nullopt;
  }
  return report->radio().nodes(static_cast<int>(node));
}

std::string end_reason(const FlightEnd& end) {
  switch (end.kind) {
    case FlightEnd::Kind::kInterrupted:
      return fmt::format("interrupted by {}", ::sigdescr_np(end.signal_number));
    case FlightEnd::Kind::kFailed:
      return end.reason;
    case FlightEnd::Kind::kStoppedLate:
      return "stopped: " + end.reason;
    case FlightEnd::Kind::kCompleted:
      break;
  }
  return "duration reached";
}

std::map<std::string, std::string> versions() {
  utsname system{};
  static_cast<void>(::uname(&system));
  return {{"cuscus", CUSCUS_VERSION}, {"kernel", system.release}};
}

/// The services that were there at the end, in good order, have reported.
void add_failures(const LiveRun& run, std::vector<std::string>& failures) {
  if (run.end().kind == FlightEnd::Kind::kFailed) {
    failures.push_back(run.end().reason);
  }
  for (const Service* const service : {run.netsim(), run.camera(), run.world()}) {
    if (service == nullptr) {
      continue;
    }
    const std::string trouble = service->trouble();
    if (!trouble.empty() && (failures.empty() || failures.front() != trouble)) {
      failures.push_back(trouble);
    }
  }
}

/// Of every vehicle, when the world has reported.
void add_collisions(const Plan& plan, const LiveRun& run, RunOutcome& outcome) {
  const auto* const report = report_of(run.world());
  if (report == nullptr || !report->has_world()) {
    return;
  }
  for (const proto::WorldNode& node : plan.world.nodes()) {
    if (node.has_multirotor()) {
      outcome.nodes.at(node.node()).collisions.emplace();
    }
  }
  for (const proto::CollisionTally& tally : report->world().collisions()) {
    outcome.nodes.at(tally.node()).collisions = tally;
  }
}

void add_cameras(const LiveRun& run, RunOutcome& outcome) {
  const auto* const report = report_of(run.camera());
  if (report == nullptr || !report->has_camera()) {
    return;
  }
  outcome.cameras = report->camera();
  for (const proto::CameraTally& tally : report->camera().cameras()) {
    outcome.nodes.at(tally.node()).camera = tally;
  }
}

}  // namespace

std::int64_t suspended_ns() {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  timespec boot{};
  timespec monotonic{};
  ::clock_gettime(CLOCK_BOOTTIME, &boot);
  ::clock_gettime(CLOCK_MONOTONIC, &monotonic);
  return (boot.tv_sec - monotonic.tv_sec) * kNanosecondsPerSecond + boot.tv_nsec -
         monotonic.tv_nsec;
}

nlohmann::ordered_json resolved_scenario(const scenario::Scenario& scenario) {
  return scenario::to_json(scenario);
}

FidelityInputs fidelity_inputs(const Plan& plan, const LiveRun& run, const RunFacts& facts) {
  FidelityInputs inputs;
  if (const auto* const report = report_of(run.netsim()); report && report->has_radio()) {
    inputs.radio = report->radio();
  }
  if (const auto* const report = report_of(run.world()); report && report->has_world()) {
    inputs.world = report->world();
  }
  add_failures(run, inputs.failures);
  const auto drops = run.tap_drops();
  inputs.tap_drops = std::accumulate(drops.begin(), drops.end(), std::uint64_t{0});
  inputs.backlog_drops = run.backlog_drops();
  if (run.crew() != nullptr) {
    for (const auto& program : run.crew()->programs()) {
      if (const auto* const report = report_of(program); report && report->has_agent()) {
        inputs.agent_loops += report->agent().loops();
        inputs.agent_overruns += report->agent().overruns();
        if (!program.plan->from_scenario) {
          const auto commands = run.commands(program.node);
          inputs.motor_stops += commands ? commands->timeouts : 0;
          inputs.sensors_lost += report->agent().sensors_lost() ? 1U : 0U;
        }
      }
    }
  }
  if (const auto* const canary = run.canary()) {
    inputs.canary = {
        .sent = canary->sent, .lost = canary->lost, .late = ipc::summary_of(canary->late)};
  }
  inputs.suspended = facts.suspended;
  inputs.longest_supervision_gap = run.longest_gap();
  inputs.realtime_wanted = plan.realtime;
  return inputs;
}

RunOutcome run_outcome(const Plan& plan, const LiveRun& run, const Sampler& sampler,
                       const RunFacts& facts) {
  RunOutcome outcome{
      .run_id = facts.run_id,
      .scenario_name = plan.scenario_name,
      .seed = plan.seed,
      .started_utc = facts.started_utc,
      .planned = plan.duration,
      .simulated = SimClock::duration{static_cast<std::int64_t>(run.end().flown_s * 1e9)},
      .end_reason = end_reason(run.end()),
      .versions = versions(),
      .exit_code = 0,
      .nodes = {},
      .formation_error = sampler.formation_error(),
      .ground_station = {}};
  const auto& radio = run.memories().radio_reader();
  const auto tap_drops = run.tap_drops();
  for (const auto& node : plan.nodes) {
    outcome.nodes.push_back(
        {.index = node.index,
         .name = node.name,
         .role = node.role,
         .radio = radio ? radio->tally(node.index) : std::nullopt,
         .emulator = service_of(node.index, run),
         .tap_dropped =
             node.index < tap_drops.size() ? std::optional{tap_drops[node.index]} : std::nullopt,
         .commands = node.role == NodeRole::kUav ? run.commands(node.index) : std::nullopt,
         .collisions = {},
         .agent = {},
         .formation_error = sampler.formation_error(node.index),
         .programs = {}});
  }
  add_collisions(plan, run, outcome);
  add_cameras(run, outcome);
  if (run.crew() == nullptr) {
    return outcome;
  }
  for (const auto& program : run.crew()->programs()) {
    auto& node = outcome.nodes[program.node];
    node.programs.push_back(outcome_of(program));
    const auto* const report = report_of(program);
    if (report != nullptr && report->has_agent()) {
      node.agent = report->agent();
    } else if (report != nullptr && report->has_ground_station()) {
      outcome.ground_station = report->ground_station();
    }
  }
  return outcome;
}

}  // namespace cuscus::orchestrator
