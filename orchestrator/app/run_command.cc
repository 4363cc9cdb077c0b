#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "common/city/transfer/city_message.h"
#include "common/posix/check.h"
#include "orchestrator/app/city_source.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/findings.h"
#include "orchestrator/app/live_run.h"
#include "orchestrator/app/ownership.h"
#include "orchestrator/app/preflight.h"
#include "orchestrator/app/print.h"
#include "orchestrator/app/run_registry.h"
#include "orchestrator/app/sampler.h"
#include "orchestrator/plan/plan.h"
#include "orchestrator/results/links.h"
#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;

RunDirectory create_run_directory(const fs::path& path, std::optional<Owner> owner) {
  try {
    return RunDirectory::create(path, owner);
  } catch (const std::system_error& error) {
    throw UsageError{error.what()};
  }
}

/// "captures/uav3.pcapng" of every node that is to be captured.
std::map<std::uint32_t, posix::UniqueFd> create_captures(const Plan& plan,
                                                         const RunDirectory& directory) {
  std::map<std::uint32_t, posix::UniqueFd> files;
  if (!plan.captured_nodes.empty()) {
    directory.create_folder(std::string{kCaptureFolder});
  }
  for (const std::uint32_t node : plan.captured_nodes) {
    files.emplace(node, directory.create_file(
                            fmt::format("{}/{}.pcapng", kCaptureFolder, plan.nodes[node].name)));
  }
  return files;
}

RegisteredRun registered(const Plan& plan, const std::string& run_id, const fs::path& scenario,
                         const fs::path& results, const std::vector<pid_t>& init_pids) {
  RegisteredRun run{.run_id = run_id,
                    .pid = ::getpid(),
                    .scenario = fs::absolute(scenario).native(),
                    .results = results.native(),
                    .started_unix_s = system_clock::to_time_t(system_clock::now()),
                    .nodes = {}};
  for (std::size_t i = 0; i < init_pids.size(); ++i) {
    run.nodes.push_back(
        {.name = plan.nodes[i].name, .address = plan.nodes[i].ip, .init_pid = init_pids[i]});
  }
  return run;
}

int exit_code_of(const FlightEnd& end, Verdict verdict, scenario::OnLate on_late) {
  switch (end.kind) {
    case FlightEnd::Kind::kInterrupted:
      return kExitSignalBase + end.signal_number;
    case FlightEnd::Kind::kFailed:
      return kExitFailed;
    case FlightEnd::Kind::kStoppedLate:
      return kExitInvalid;
    case FlightEnd::Kind::kCompleted:
      break;
  }
  const bool is_refused = on_late == scenario::OnLate::kWarn ? verdict == Verdict::kInvalid
                                                             : verdict != Verdict::kValid;
  return is_refused ? kExitInvalid : kExitDone;
}

/// Gives a run's results to `owner` when it goes, however the run has ended.
class Handover {
 public:
  Handover(const RunDirectory& directory, std::optional<Owner> owner)
      : directory_{directory}, owner_{owner} {}
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;
  ~Handover() {
    if (owner_) {
      directory_.give_to(*owner_);
    }
  }

 private:
  const RunDirectory& directory_;
  std::optional<Owner> owner_;
};

/// A new file, if it is wanted.
posix::UniqueFd file_if(bool wanted, const RunDirectory& directory, std::string_view name) {
  return wanted ? directory.create_file(std::string{name}) : posix::UniqueFd{};
}

/// False when it could not be written, and why is said.
bool save(const RunDirectory& directory, std::string_view name, const std::string& content) {
  try {
    directory.write_file(std::string{name}, content);
    return true;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return false;
  }
}

/// What was counted per link; true when there is nothing to save.
bool save_links(const RunDirectory& directory, const Plan& plan, const LiveRun& run) {
  const auto& radio = run.memories().radio_reader();
  if (!radio) {
    return true;
  }
  std::vector<std::string> names;
  for (const auto& node : plan.nodes) {
    names.push_back(node.name);
  }
  return save(directory, kLinksFile, links_csv(names, *radio));
}

void print_end(const FlightEnd& end, const RunOutcome& outcome, const Fidelity& fidelity,
               const fs::path& results) {
  if (end.kind == FlightEnd::Kind::kFailed) {
    print(stderr, "cuscus: the run failed after {:.1f} s: {}\n", end.flown_s, end.reason);
  } else if (end.kind == FlightEnd::Kind::kInterrupted) {
    print(stderr, "cuscus: interrupted by {} after {:.1f} s\n", ::sigdescr_np(end.signal_number),
          end.flown_s);
  } else if (end.kind == FlightEnd::Kind::kStoppedLate) {
    print(stderr, "cuscus: the run was stopped after {:.1f} s: it {}\n", end.flown_s, end.reason);
  }
  if (outcome.formation_error) {
    print(stdout,
          "formation error: median {:.3f} m, 95 % below {:.3f} m (second half of the flight)\n",
          outcome.formation_error->p50_m, outcome.formation_error->p95_m);
  }
  print(stdout, "results {}\n{}\n", results.native(), verdict_line(fidelity));
}

/// Judges the run, saves what can be saved and says how it ended; its exit code.
int conclude(const Plan& plan, const FlightEnd& end, RunOutcome outcome,
             const FidelityInputs& inputs, const RunDirectory& directory, bool links_saved) {
  const Fidelity fidelity = judge(inputs);
  outcome.exit_code = exit_code_of(end, fidelity.verdict, plan.on_late);
  if (!save(directory, kFidelityFile, to_json(fidelity, inputs).dump(2) + "\n") || !links_saved) {
    outcome.exit_code = kExitFailed;
  }
  if (!save(directory, kSummaryFile, to_json(outcome, fidelity).dump(2) + "\n")) {
    outcome.exit_code = kExitFailed;
  }
  print_end(end, outcome, fidelity, directory.path());
  return outcome.exit_code;
}

}  // namespace

int run_command(const RunArguments& arguments) {
  const scenario::Scenario scenario = load(arguments.scenario);
  const Plan plan = make_plan(scenario);
  for (const auto& warning : plan.capacity.warnings) {
    spdlog::warn("{}", warning);
  }

  const std::string city = load_city(scenario);

  // Named before an ordinary user becomes root of a namespace, for `cuscus ps` to look there too.
  const RunRegistry registry{RunRegistry::default_folder()};
  const node::Rights rights = acquire_run_rights();
  check_tun();
  const fs::path programs = check_own_programs();
  check_open_files(plan);
  posix::UniqueFd page_listener;
  if (plan.page_port) {
    page_listener = listen_for_page(*plan.page_port);
  }
  for (const auto& dead : registry.sweep()) {
    spdlog::info("removed what run {} had left behind", dead);
  }
  const std::string run_id =
      make_run_id(plan.scenario_name, system_clock::now(), std::random_device{}());
  const fs::path results = fs::absolute(arguments.out.value_or(fs::path{"runs"} / run_id));
  const auto entry = registry.enter(registered(plan, run_id, arguments.scenario.file, results, {}));
  const RunDirectory directory = create_run_directory(results, sudo_caller());
  const Handover handover{directory, sudo_caller()};
  directory.write_file(std::string{kResolvedScenarioFile},
                       resolved_scenario(scenario).dump(2) + "\n");

  if (!city.empty()) {
    directory.write_file(city::kCityFile, city);
  }

  const bool page = static_cast<bool>(page_listener);
  print(stderr, "run {}: {} nodes for {:.0f} s{}\n", run_id, plan.nodes.size(),
        to_seconds(plan.duration),
        page ? fmt::format(", page http://127.0.0.1:{}", *plan.page_port) : "");
  RunFacts facts{.run_id = run_id, .started_utc = utc_text(system_clock::now())};
  const std::int64_t suspended_before_ns = suspended_ns();
  MetricsWriter metrics{directory.create_file(std::string{kMetricsFile})};
  LiveRun run{plan,
              {.run_id = run_id,
               .rights = rights,
               .programs = programs,
               .directory = directory,
               .page_listener = std::move(page_listener),
               .city = city_memory(city),
               .frame_log = file_if(plan.record_frames, directory, kFrameLogFile),
               .reception_log = file_if(plan.record_receptions, directory, kReceptionLogFile),
               .captures = create_captures(plan, directory)}};
  run.on_nodes_built([&] {
    entry.publish(
        registered(plan, run_id, arguments.scenario.file, directory.path(), run.init_pids()));
  });
  Sampler sampler{plan, run, metrics};
  if (run.set_up()) {
    run.fly([&](double sim_time_s) { sampler.sample(sim_time_s); });
  }

  facts.suspended = std::chrono::nanoseconds{suspended_ns() - suspended_before_ns};
  RunOutcome outcome = run_outcome(plan, run, sampler, facts);
  outcome.metrics_rows_dropped = metrics.rows_dropped();
  const bool links_saved = save_links(directory, plan, run);
  return conclude(plan, run.end(), std::move(outcome), fidelity_inputs(plan, run, facts), directory,
                  links_saved);
}

}  // namespace cuscus::orchestrator
