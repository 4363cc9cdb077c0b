#include <fmt/core.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "orchestrator/app/commands.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/run_registry.h"
#include "orchestrator/node/enter_node.h"
#include "orchestrator/node/environment_checks.h"
#include "orchestrator/node/rights.h"

namespace cuscus::orchestrator {
namespace {

using namespace std::chrono_literals;

/// Longer than a graceful stop takes.
constexpr auto kStopLimit = 10s;

std::string ids_of(const std::vector<RegisteredRun>& runs) {
  std::string ids;
  for (const auto& run : runs) {
    ids += (ids.empty() ? "" : ", ") + run.run_id;
  }
  return ids;
}

RegisteredRun chosen_run(const std::string& run_id) {
  const auto runs = RunRegistry{RunRegistry::default_folder()}.runs();
  if (runs.empty()) {
    throw UsageError{"no run is alive"};
  }
  if (run_id.empty()) {
    if (runs.size() > 1) {
      throw UsageError{"several runs are alive, name one: " + ids_of(runs)};
    }
    return runs.front();
  }
  const auto found =
      std::find_if(runs.begin(), runs.end(), [&](const auto& run) { return run.run_id == run_id; });
  if (found == runs.end()) {
    throw UsageError{fmt::format("no run '{}' is alive; alive: {}", run_id, ids_of(runs))};
  }
  return *found;
}

bool is_alive(const std::string& run_id) {
  const auto runs = RunRegistry{RunRegistry::default_folder()}.runs();
  return std::any_of(runs.begin(), runs.end(),
                     [&](const auto& run) { return run.run_id == run_id; });
}

}  // namespace

int ps_command(bool json) {
  const auto runs = RunRegistry{RunRegistry::default_folder()}.runs();
  if (json) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& run : runs) {
      auto nodes = nlohmann::ordered_json::array();
      for (const auto& node : run.nodes) {
        nodes.push_back(
            {{"name", node.name}, {"address", node.address}, {"init_pid", node.init_pid}});
      }
      list.push_back({{"run_id", run.run_id},
                      {"pid", run.pid},
                      {"scenario", run.scenario},
                      {"results", run.results},
                      {"started_unix_s", run.started_unix_s},
                      {"nodes", nodes}});
    }
    fmt::print("{}\n", list.dump(2));
    return kExitDone;
  }
  fmt::print("{:<44} {:>8} {:>6} {:>7}  {}\n", "RUN", "PID", "NODES", "AGE", "RESULTS");
  for (const auto& run : runs) {
    fmt::print("{:<44} {:>8} {:>6} {:>5} s  {}\n", run.run_id, run.pid, run.nodes.size(),
               std::time(nullptr) - run.started_unix_s, run.results);
  }
  return kExitDone;
}

int stop_command(const std::string& run_id) {
  const RegisteredRun run = chosen_run(run_id);
  const posix::UniqueFd process = posix::open_pidfd(run.pid);
  // Only now is the number sure to be the run's: its lock was held while the pidfd was opened.
  if (!is_alive(run.run_id)) {
    throw UsageError{"run " + run.run_id + " has just ended"};
  }
  if (::syscall(SYS_pidfd_send_signal, process.get(), SIGINT, nullptr, 0) != 0 && errno != ESRCH) {
    posix::throw_errno("signal the run");
  }
  const auto deadline = std::chrono::steady_clock::now() + kStopLimit;
  while (is_alive(run.run_id)) {
    if (std::chrono::steady_clock::now() >= deadline) {
      fmt::print(stderr, "cuscus: run {} has not ended within {} s; 'kill -9 {}' leaves nothing\n",
                 run.run_id, std::chrono::seconds{kStopLimit}.count(), run.pid);
      return kExitFailed;
    }
    std::this_thread::sleep_for(20ms);
  }
  fmt::print("stopped {}; results {}\n", run.run_id, run.results);
  return kExitDone;
}

int exec_command(const std::string& run_id, const std::string& node,
                 const std::vector<std::string>& arguments) {
  const RegisteredRun run = chosen_run(run_id);
  const auto found = std::find_if(run.nodes.begin(), run.nodes.end(),
                                  [&](const auto& candidate) { return candidate.name == node; });
  if (found == run.nodes.end()) {
    std::string names;
    for (const auto& candidate : run.nodes) {
      names += (names.empty() ? "" : ", ") + candidate.name;
    }
    throw UsageError{fmt::format("run {} has no node '{}'; it has: {}", run.run_id, node, names)};
  }
  std::vector<std::string> environment;
  for (const char* const name : {"PATH", "HOME", "TERM", "LANG", "USER"}) {
    // Read while there is one thread.
    if (const char* const value = std::getenv(name)) {  // NOLINT(concurrency-mt-unsafe)
      environment.push_back(std::string{name} + "=" + value);
    }
  }
  return node::enter_node(
      {.init_pid = found->init_pid, .arguments = arguments, .environment = environment});
}

int clean_command() {
  const auto removed = RunRegistry{RunRegistry::default_folder()}.sweep();
  for (const auto& run_id : removed) {
    fmt::print("removed {}\n", run_id);
  }
  fmt::print("{} dead runs cleaned; {} alive\n", removed.size(),
             RunRegistry{RunRegistry::default_folder()}.runs().size());
  return kExitDone;
}

int doctor_command(std::size_t nodes) {
  using Result = node::EnvironmentCheck::Result;
  bool can_run = true;
  for (const auto& check : node::check_environment(nodes)) {
    const char* const word = check.result == Result::kOk        ? "ok"
                             : check.result == Result::kWarning ? "warning"
                                                                : "FAIL";
    fmt::print("{:<8} {:<18} {}\n", word, check.name, check.text);
    if (!check.remedy.empty()) {
      fmt::print("{:<27} {}\n", "", check.remedy);
    }
    can_run = can_run && check.result != Result::kFail;
  }
  fmt::print("{}\n", can_run ? "runs work here" : "runs do not work here");
  return can_run ? kExitDone : kExitFailed;
}

}  // namespace cuscus::orchestrator
