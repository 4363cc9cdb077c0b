#include "orchestrator/app/live_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "orchestrator/app/run_trouble.h"

namespace cuscus::orchestrator {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Together below the five seconds in which an interrupted run has to be over.
constexpr milliseconds kCrewStopLimit{1'500};
constexpr milliseconds kTerminateLimit{700};
constexpr milliseconds kKillLimit{500};
constexpr milliseconds kServiceStopLimit{1'500};
constexpr milliseconds kProgressPeriod{200};

/// As nohup(1) leaves SIGHUP, so that the terminal may be closed.
bool is_ignored(int signal_number) {
  struct sigaction action {};
  posix::check("sigaction", ::sigaction(signal_number, nullptr, &action));
  return action.sa_handler == SIG_IGN;
}

}  // namespace

LiveRun::LiveRun(const Plan& plan, RunSettings settings)
    : plan_{plan},
      settings_{std::move(settings)},
      signals_{loop_, SIGINT, SIGTERM},
      memories_{static_cast<std::uint32_t>(plan.nodes.size()), vehicles()} {
  if (!is_ignored(SIGHUP)) {
    signals_.add(SIGHUP);
  }
  watch_signals();
}

LiveRun::~LiveRun() = default;

template <typename Body>
bool LiveRun::guarded(const Body& body) {
  try {
    body();
    return true;
  } catch (const RunInterrupted&) {
    end_.kind = FlightEnd::Kind::kInterrupted;
    end_.signal_number = signal_number_;
  } catch (const RunLate& late) {
    end_.kind = FlightEnd::Kind::kStoppedLate;
    end_.reason = late.what();
  } catch (const std::exception& error) {
    end_.kind = FlightEnd::Kind::kFailed;
    end_.reason = error.what();
  }
  end_.flown_s = sim_time_s();
  return false;
}

bool LiveRun::set_up() {
  return guarded([&] {
    start_world();
    start_camera();
    reserve_processor();
    build_nodes();
    start_netsim();
    start_programs();
  });
}

void LiveRun::fly(const OnSample& on_sample) {
  guarded([&] {
    start_clock();
    Progress progress{plan_.duration};
    const auto start = steady_clock::time_point{std::chrono::nanoseconds{start_monotonic_ns_}};
    const auto finish = start + plan_.duration;
    auto next_sample = start;
    auto next_progress = start;
    auto last_look = start;
    while (steady_clock::now() < finish) {
      wait_step(std::min({next_sample, next_progress, finish}));
      check_trouble();
      const auto now = steady_clock::now();
      longest_gap_ = std::max(longest_gap_, std::chrono::nanoseconds{now - last_look});
      last_look = now;
      if (now >= next_sample) {
        on_sample(sim_time_s());
        // What a slow disk has missed is missed, not made up for.
        next_sample += plan_.metrics_period * ((now - next_sample) / plan_.metrics_period + 1);
      }
      if (now >= next_progress) {
        check_heartbeats();
        check_validity();
        progress.show(now - start, progress_text());
        next_progress = now + kProgressPeriod;
      }
    }
    end_.flown_s = std::chrono::duration<double>{plan_.duration}.count();
  });
  const double flown_s = end_.flown_s;
  guarded([&] { stop_all(); });
  end_.flown_s = flown_s;
}

void LiveRun::stop_all() {
  if (canary_) {
    canary_->stop();
  }
  if (const auto& fleet = memories_.fleet_reader()) {
    for (const auto& node : plan_.nodes) {
      commands_.push_back(fleet->commands(node.index));
    }
  }
  const std::string reason =
      end_.kind == FlightEnd::Kind::kCompleted ? "the flight is over" : "the run has ended early";
  if (crew_) {
    crew_->stop(reason);
    const auto ended = [&] { return crew_->all_have_ended(); };
    if (!settle(kCrewStopLimit, ended)) {
      crew_->terminate();
      if (!settle(kTerminateLimit, ended)) {
        crew_->kill();
        settle(kKillLimit, ended);
      }
    }
  }
  const auto started = services();
  for (auto service = started.rbegin(); service != started.rend(); ++service) {
    (*service)->component().stop(reason);
  }
  settle(kServiceStopLimit, [&] {
    return std::ranges::all_of(
        started, [](const Service* service) { return service->status().has_value(); });
  });
}

std::vector<Service*> LiveRun::services() const {
  std::vector<Service*> started;
  for (Service* const service : {world_.get(), camera_.get(), netsim_.get()}) {
    if (service != nullptr) {
      started.push_back(service);
    }
  }
  return started;
}

double LiveRun::sim_time_s() const {
  return start_monotonic_ns_ == 0
             ? 0.0
             : std::max(0.0, static_cast<double>(posix::monotonic_now_ns() - start_monotonic_ns_) *
                                 1e-9);
}

std::string LiveRun::progress_text() const {
  std::size_t flying = 0;
  std::size_t agents = 0;
  for (const auto& node : plan_.nodes) {
    if (node.agent) {
      ++agents;
      flying += crew_->state_of(node.index) == "flying" ? 1U : 0U;
    }
  }
  std::string text = fmt::format("{}/{} flying", flying, agents);
  if (const auto timing = memories_.radio_reader()->timing()) {
    text += fmt::format(", {} receptions, late p99 {:.3f} ms", timing->releases,
                        static_cast<double>(timing->release_lateness_p99_ns) * 1e-6);
  }
  return text;
}

std::vector<std::uint64_t> LiveRun::tap_drops() const {
  std::vector<std::uint64_t> drops;
  if (fleet_) {
    for (const auto& node : fleet_->nodes()) {
      try {
        drops.push_back(node.tap_counters(fleet_->fabric()).send_drops);
      } catch (const std::exception&) {
        drops.push_back(0);  // its program has deleted the interface: nothing can be lost there
      }
    }
  }
  return drops;
}

std::optional<shm::CommandTally> LiveRun::commands(std::uint32_t node) const {
  return node < commands_.size() ? commands_[node] : std::nullopt;
}

std::vector<pid_t> LiveRun::init_pids() const {
  std::vector<pid_t> pids;
  if (fleet_) {
    for (const auto& node : fleet_->nodes()) {
      pids.push_back(node.init_pid());
    }
  }
  return pids;
}

}  // namespace cuscus::orchestrator
