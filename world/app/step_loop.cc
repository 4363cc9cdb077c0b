#include "world/app/step_loop.h"

#include <algorithm>
#include <concepts>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "common/city/transfer/city_message.h"
#include "common/ipc/duration_summary.h"
#include "common/log/log.h"
#include "common/posix/resource_usage.h"
#include "common/posix/shared_memory.h"
#include "common/statistics/log2_histogram.h"
#include "world/app/run_city.h"
#include "world/app/world_memory.h"

namespace cuscus::world {
namespace {

constexpr std::int64_t kLookPeriod_ns = 20'000'000;
constexpr std::int64_t kBeatPeriod_ns = 500'000'000;

/// The conversation with the orchestrator during the run.
class Heartbeat {
 public:
  explicit Heartbeat(ipc::ChildSession& session) : session_{&session} {}

  /// Whether to go on. Cheap when called again within the period. `so_far` makes the report of what
  /// has been by now.
  template <std::invocable SoFar>
  bool goes_on(std::int64_t now_ns, SimTime time, const SoFar& so_far) {
    if (now_ns < next_look_ns_) {
      return true;
    }
    next_look_ns_ = now_ns + kLookPeriod_ns;
    if (now_ns >= next_beat_ns_) {
      next_beat_ns_ = now_ns + kBeatPeriod_ns;
      proto::Report report;
      *report.mutable_world() = so_far();
      session_->beat(to_ns(time), report);
    }
    return !session_->stop_requested();
  }

 private:
  ipc::ChildSession* session_;
  std::int64_t next_look_ns_{std::numeric_limits<std::int64_t>::min()};
  std::int64_t next_beat_ns_{std::numeric_limits<std::int64_t>::min()};
};

/// Waits for `deadline_ns` in naps, so that Stop and a dead orchestrator are seen meanwhile.
template <std::invocable SoFar>
bool wait_until(std::int64_t deadline_ns, Heartbeat& heartbeat, StepHost& host,
                const SoFar& so_far) {
  for (std::int64_t now_ns = host.now_ns(); now_ns < deadline_ns; now_ns = host.now_ns()) {
    if (!heartbeat.goes_on(now_ns, SimTime{}, so_far)) {
      return false;
    }
    host.sleep_until_ns(std::min(deadline_ns, now_ns + kLookPeriod_ns));
  }
  return true;
}

void log_tallies(const FleetSimulation& simulation) {
  for (const auto& [name, commands] : simulation.tallies()) {
    const std::uint64_t rejected =
        commands.rejected_not_finite + commands.rejected_out_of_range + commands.rejected_torn;
    if (rejected != 0 || commands.timeouts != 0) {
      spdlog::warn(
          "{}: {} commands accepted; rejected: {} not finite, {} out of range, {} torn; motors "
          "stopped {} times for want of a command",
          name, commands.accepted, commands.rejected_not_finite, commands.rejected_out_of_range,
          commands.rejected_torn, commands.timeouts);
    }
  }
}

void log_first_contacts(const FleetSimulation& simulation) {
  for (const auto& contact : simulation.collisions().first_contacts()) {
    const Eigen::Vector3d& p_m = contact.p_WB_m;
    spdlog::warn("{} hit {} at ({:.2f}, {:.2f}, {:.2f}) m with {:.2f} m/s{}", contact.name,
                 contact.what, p_m.x(), p_m.y(), p_m.z(), contact.speed_mps,
                 contact.crash ? " and crashed" : "");
  }
}

}  // namespace

proto::WorldReport run_steps(FleetSimulation& simulation, ipc::ChildSession& session,
                             StepHost& host, std::int64_t start_monotonic_ns) {
  const std::int64_t step_ns = simulation.step_length().count();
  statistics::Log2Histogram lateness;
  std::uint64_t overruns = 0;
  Heartbeat heartbeat{session};
  const auto report_so_far = [&] {
    proto::WorldReport report;
    report.set_steps(simulation.steps());
    report.set_overruns(overruns);
    *report.mutable_step_lateness() = ipc::summary_of(lateness);
    report.set_scheduler(host.scheduler());
    report.set_cpu_s(posix::process_cpu_s());
    simulation.collisions().report(report);
    return report;
  };

  if (wait_until(start_monotonic_ns, heartbeat, host, report_so_far)) {
    simulation.begin();
    std::int64_t now_ns = host.now_ns();
    for (std::int64_t due_ns = start_monotonic_ns + step_ns;
         heartbeat.goes_on(now_ns, simulation.time(), report_so_far); due_ns += step_ns) {
      if (now_ns < due_ns) {
        host.sleep_until_ns(due_ns);
        now_ns = host.now_ns();
      }
      lateness.add(now_ns - due_ns);
      simulation.step();
      now_ns = host.now_ns();
      log_first_contacts(simulation);
      overruns += now_ns > due_ns + step_ns ? 1 : 0;
      simulation.publish_progress(overruns);
    }
  }

  simulation.publish_tallies();
  return report_so_far();
}

namespace {

/// What the fleet flies in; null: the bare ground.
std::unique_ptr<const RunCity> take_city(ipc::ChildSession& session) {
  const auto memory = session.take_if_given(proto::Descriptors::KIND_CITY);
  if (!memory) {
    return nullptr;
  }
  const auto mapping = posix::MemoryMapping::read_only(*memory);
  return std::make_unique<RunCity>(city::from_bytes(mapping.bytes()));
}

}  // namespace

void run_world(ipc::ChildSession& session, StepHost& host) {
  const proto::Configure configure = session.await_configuration();
  if (!configure.has_world()) {
    throw std::invalid_argument{"Configure holds no world configuration"};
  }
  const proto::WorldConfiguration& configuration = configure.world();
  const auto city = take_city(session);
  FleetSimulation simulation{configuration, map_memory(session, configuration), city.get()};
  host.prepare(configuration.realtime_priority());
  session.ready();
  spdlog::info("ready: {} nodes, {} of them vehicles, step {} us, {}", configuration.nodes_size(),
               simulation.tallies().size(), simulation.step_length().count() / 1000,
               host.scheduler());

  proto::Report report;
  if (const auto start_monotonic_ns = session.await_start()) {
    *report.mutable_world() = run_steps(simulation, session, host, *start_monotonic_ns);
  } else {
    report.mutable_world()->set_scheduler(host.scheduler());
  }
  log_tallies(simulation);
  spdlog::info("stopped after {} steps, {} overruns, lateness p99 {} us, max {} us",
               report.world().steps(), report.world().overruns(),
               report.world().step_lateness().p99_ns() / 1000,
               report.world().step_lateness().max_ns() / 1000);
  session.report(report);
}

}  // namespace cuscus::world
