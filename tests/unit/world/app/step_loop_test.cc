#include "world/app/step_loop.h"

#include <catch2/catch.hpp>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "tests/unit/world/app/run_of_world.h"

namespace cuscus::world {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kStart_ns = 5'000'000'000;

/// A machine whose clock moves only when somebody sleeps, and which wakes up as late as it is told.
class ScriptedHost final : public StepHost {
 public:
  /// Called with the time at which each sleep ends; may move it on.
  std::function<void(std::int64_t&)> on_wake = [](std::int64_t&) {};
  int priority{-1};

  void prepare(int realtime_priority) override { priority = realtime_priority; }
  [[nodiscard]] std::int64_t now_ns() override { return now_ns_; }
  void sleep_until_ns(std::int64_t deadline_ns) override {
    CHECK(deadline_ns > now_ns_);  // a late loop does not sleep
    now_ns_ = deadline_ns;
    on_wake(now_ns_);
  }
  [[nodiscard]] std::string scheduler() const override { return "scripted"; }

 private:
  std::int64_t now_ns_{kStart_ns - 50 * kMillisecond_ns};
};

/// The orchestrator's end of a run with one X4 and a ground station; everything that the world
/// waits for is in the socket beforehand.
struct Orchestrator {
  Orchestrator() : Orchestrator{ipc::ControlSocket::pair()} {}

  void send_configuration(const proto::WorldConfiguration& configuration) {
    memories.send_descriptors(socket);
    proto::Envelope envelope;
    *envelope.mutable_configure()->mutable_world() = configuration;
    socket.send(envelope);
  }
  void send_start() {
    proto::Envelope envelope;
    envelope.mutable_start()->set_start_monotonic_ns(kStart_ns);
    socket.send(envelope);
  }
  void send_stop() {
    proto::Envelope envelope;
    envelope.mutable_stop();
    socket.send(envelope);
  }
  /// Everything that the world has sent.
  [[nodiscard]] std::vector<proto::Envelope> received() {
    std::vector<proto::Envelope> envelopes;
    while (auto message = socket.try_receive()) {
      envelopes.push_back(std::move(message->envelope));
    }
    return envelopes;
  }

  RunOfWorld memories{2, {0}};
  ipc::ControlSocket socket;
  ipc::ChildSession session;

 private:
  explicit Orchestrator(std::pair<ipc::ControlSocket, ipc::ControlSocket> ends)
      : socket{std::move(ends.first)}, session{std::move(ends.second)} {}
};

proto::WorldConfiguration one_vehicle_and_a_station() {
  proto::WorldConfiguration configuration = fleet_configuration(1);
  configuration.add_nodes()->set_node(1);
  configuration.set_realtime_priority(40);
  return configuration;
}

TEST_CASE("a world that is never late runs every step, beats at least every second and reports") {
  Orchestrator orchestrator;
  ScriptedHost host;
  orchestrator.send_configuration(one_vehicle_and_a_station());
  orchestrator.send_start();
  host.on_wake = [&](std::int64_t& now_ns) {
    const std::int64_t sim_time_ns = now_ns - kStart_ns;
    if (sim_time_ns >= 0) {
      // An agent that hovers from 1 s on.
      const double u = sim_time_ns < 1'000 * kMillisecond_ns ? 0.0 : 0.66;
      orchestrator.memories.command(0, static_cast<std::uint64_t>(sim_time_ns + 1), {u, u, u, u});
    }
    now_ns += 30'000;  // wakes 30 us late
    if (sim_time_ns == 2'500 * kMillisecond_ns) {
      orchestrator.send_stop();
    }
  };

  run_world(orchestrator.session, host);

  const auto messages = orchestrator.received();
  REQUIRE(messages.size() >= 3);
  CHECK(messages.front().has_ready());
  REQUIRE(messages.back().has_report());
  CHECK(std::count_if(messages.begin(), messages.end(),
                      [](const auto& message) { return message.has_status(); }) >= 3);
  const auto last_beat = std::find_if(messages.rbegin(), messages.rend(),
                                      [](const auto& message) { return message.has_status(); });
  CHECK(last_beat->status().so_far().world().steps() >= 2000);
  CHECK(last_beat->status().so_far().world().step_lateness().max_ns() == 30'000);
  const proto::WorldReport& report = messages.back().report().world();
  CHECK(report.steps() >= 2500);
  CHECK(report.steps() <= 2500 + 20);  // Stop is looked for every 20 ms
  CHECK(report.overruns() == 0);
  CHECK(report.scheduler() == "scripted");
  CHECK(report.step_lateness().count() == report.steps());
  CHECK(report.step_lateness().p50_ns() == 30'000);
  CHECK(report.step_lateness().max_ns() == 30'000);
  CHECK(host.priority == 40);

  const auto mapping = orchestrator.memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  CHECK(fleet.steps() == report.steps());
  CHECK(fleet.state(0)->p_WB_m[2] > 0.5);
  CHECK(fleet.commands(0)->accepted >= 2500);
  CHECK(fleet.commands(0)->timeouts == 0);
}

TEST_CASE("a world that was held up makes up for every step and counts the late ones") {
  Orchestrator orchestrator;
  ScriptedHost host;
  orchestrator.send_configuration(one_vehicle_and_a_station());
  orchestrator.send_start();
  host.on_wake = [&](std::int64_t& now_ns) {
    if (now_ns == kStart_ns + 100 * kMillisecond_ns) {
      now_ns += 2'000 * kMillisecond_ns;  // the machine was elsewhere for two seconds
    }
    if (now_ns == kStart_ns + 3'000 * kMillisecond_ns) {
      orchestrator.send_stop();
    }
  };

  run_world(orchestrator.session, host);

  const proto::Envelope last = orchestrator.received().back();
  const proto::WorldReport& report = last.report().world();
  // None is left out: after 3 s (and up to 20 ms until Stop is seen) as many steps as milliseconds.
  CHECK(report.steps() >= 3000);
  CHECK(report.steps() <= 3020);
  // Step 100 ended 2 s late, 101 by 1.999 s, ... 2099 by 1 ms; overrun means by more than 1 ms.
  CHECK(report.overruns() == 1999);
  CHECK(report.step_lateness().max_ns() == 2'000 * kMillisecond_ns);
  const auto& bins = report.step_lateness().log2_bins();
  CHECK(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}) == report.steps());
  // [2^30, 2^31) ns holds 1.073742 s and above: lateness of 1.074 s ... 2 s.
  CHECK(bins[30] == 927);
}

TEST_CASE("a stop before the start ends in a report without steps") {
  Orchestrator orchestrator;
  ScriptedHost host;
  orchestrator.send_configuration(one_vehicle_and_a_station());
  orchestrator.send_stop();

  run_world(orchestrator.session, host);

  const auto messages = orchestrator.received();
  REQUIRE(messages.size() == 2);
  CHECK(messages[0].has_ready());
  CHECK(messages[1].report().world().steps() == 0);
}

TEST_CASE("a stop before time 0 is obeyed") {
  Orchestrator orchestrator;
  ScriptedHost host;
  orchestrator.send_configuration(one_vehicle_and_a_station());
  orchestrator.send_start();
  orchestrator.send_stop();

  run_world(orchestrator.session, host);

  CHECK(orchestrator.received().back().report().world().steps() == 0);
  CHECK(host.now_ns() < kStart_ns);
}

TEST_CASE("a world whose orchestrator is gone ends at once") {
  auto orchestrator = std::make_unique<Orchestrator>();
  ScriptedHost host;
  orchestrator->send_configuration(one_vehicle_and_a_station());
  orchestrator->send_start();
  std::int64_t last_wake_ns = 0;
  host.on_wake = [&](std::int64_t& now_ns) {
    last_wake_ns = now_ns;
    if (now_ns == kStart_ns + 500 * kMillisecond_ns) {
      const posix::UniqueFd dropped = std::move(orchestrator->socket).release();
    }
  };

  CHECK_THROWS_AS(run_world(orchestrator->session, host), ipc::PeerError);
  CHECK(last_wake_ns <= kStart_ns + 525 * kMillisecond_ns);
}

TEST_CASE("a world without its memories, or told to be something else, refuses") {
  Orchestrator orchestrator;
  ScriptedHost host;

  SECTION("no descriptors") {
    proto::Envelope envelope;
    *envelope.mutable_configure()->mutable_world() = one_vehicle_and_a_station();
    orchestrator.socket.send(envelope);
    CHECK_THROWS_AS(run_world(orchestrator.session, host), ipc::PeerError);
  }
  SECTION("an agent's configuration") {
    proto::Envelope envelope;
    envelope.mutable_configure()->mutable_agent();
    orchestrator.socket.send(envelope);
    CHECK_THROWS_AS(run_world(orchestrator.session, host), std::invalid_argument);
  }
}

}  // namespace
}  // namespace cuscus::world
