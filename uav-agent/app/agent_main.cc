// cuscus-agent: the autopilot of one UAV and its circle mission.
#include <cstdlib>
#include <exception>
#include <string>

#include "common/ipc/child_session.h"
#include "common/log/log.h"
#include "common/posix/resource_usage.h"
#include "common/posix/scheduling.h"
#include "uav-agent/app/agent.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/sim/sim_session.h"

namespace {

using namespace cuscus;  // NOLINT(google-build-using-namespace): a program's own main file

constexpr SimClock::duration kBeatPeriod = std::chrono::milliseconds{250};

void log_state(const std::string& name, const agent::Agent& agent, SimTime now) {
  const auto state = flight::name(agent.state());
  if (agent.state() == flight::FlightState::kFailsafe) {
    spdlog::warn("{}: {} at {:.3f} s: {}", name, state, to_seconds(now.time_since_epoch()),
                 flight::name(agent.failsafe_reason()));
  } else {
    spdlog::info("{}: {} at {:.3f} s", name, state, to_seconds(now.time_since_epoch()));
  }
}

void fly(sdk::SimSession& session, agent::Agent& agent) {
  const sdk::Clock& clock = session.vehicle().clock();
  const std::string& name = session.configuration().name();
  sdk::PeriodicTimer beat{kBeatPeriod};
  auto state = agent.state();
  while (!session.stop_requested()) {
    clock.sleep_until(agent.deadline());
    const SimTime now = clock.now();
    agent.run(now);
    const bool changed = agent.state() != state;
    if (changed) {
      state = agent.state();
      log_state(name, agent, now);
    }
    if (changed || beat.due(now)) {
      beat.advance(now);
      session.beat(std::string{flight::name(state)});
    }
  }
}

void run_session(ipc::ChildSession& child) {
  sdk::SimSession session{child};
  const auto& configuration = session.configuration();
  if (configuration.neighbours() == proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE &&
      session.vehicle().fleet() == nullptr) {
    throw ipc::PeerError{"neighbours by motion capture, but no motion-capture memory was given"};
  }
  agent::Agent agent{configuration, session.vehicle()};
  if (configuration.realtime_priority() > 0 &&
      !posix::try_realtime_scheduling(configuration.realtime_priority())) {
    spdlog::info("{}: runs under {}, SCHED_FIFO was refused", configuration.name(),
                 posix::scheduling_class());
  }
  if (session.wait_for_start()) {
    fly(session, agent);
  }
  proto::AgentReport report = agent.report();
  report.set_cpu_s(posix::process_cpu_s());
  report.set_resident_bytes(posix::resident_bytes());
  if (agent.send_errors() > 0) {
    spdlog::warn("{}: {} datagrams were not sent", configuration.name(), agent.send_errors());
  }
  session.finish(report);
}

/// Tells the orchestrator why, unless it is what failed.
void run_child(ipc::ChildSession& child) {
  try {
    run_session(child);
  } catch (const ipc::PeerError&) {
    throw;
  } catch (const std::exception& error) {
    child.fail(error.what());
    throw;
  }
}

}  // namespace

int main() {
  log::start("agent");
  try {
    auto child = ipc::ChildSession::from_environment();
    run_child(child);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return EXIT_FAILURE;
  }
}
