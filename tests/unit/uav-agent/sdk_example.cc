// The example of docs/sdk.md, flown by the test below.
#include <catch2/catch.hpp>
#include <string>
#include <thread>

#include "tests/unit/uav-agent/simulated_run.h"

// [example]
#include "common/ipc/child_session.h"
#include "uav-agent/flight/autopilot.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/sim/sim_session.h"

namespace example {

/// Takes off and hovers 3 m above where the vehicle stood, until the run ends.
void hover(cuscus::ipc::ChildSession& child) {
  using namespace std::chrono_literals;
  cuscus::sdk::SimSession session{child};
  cuscus::sdk::Vehicle& vehicle = session.vehicle();
  cuscus::flight::Autopilot autopilot{cuscus::flight::Airframe{}};
  cuscus::sdk::PeriodicTimer control{5ms};
  cuscus::sdk::PeriodicTimer beat{250ms};
  cuscus::proto::AgentReport report;
  autopilot.take_off(3.0);
  if (session.wait_for_start()) {
    while (!session.stop_requested()) {
      vehicle.clock().sleep_until(control.deadline());
      const cuscus::SimTime now = vehicle.clock().now();
      report.set_overruns(report.overruns() + control.advance(now));
      report.set_loops(report.loops() + 1);
      autopilot.sense(now, vehicle.sensors().imu(), vehicle.sensors().motion_capture());
      // Without a set-point it holds the place it took off to; give one to go somewhere.
      vehicle.actuators().set_motors(autopilot.act(now, std::nullopt), now);
      if (beat.due(now)) {
        beat.advance(now);
        session.beat(std::string{name(autopilot.state())});
      }
    }
  }
  report.set_final_state(std::string{name(autopilot.state())});
  session.finish(report);
}

}  // namespace example
// [example]

namespace {

TEST_CASE("the SDK's example lives from its start to its report and drives its motors") {
  cuscus::tests::SimulatedRun run;
  cuscus::proto::AgentConfiguration configuration;
  configuration.set_node(cuscus::tests::SimulatedRun::kNode);
  run.configure(configuration);
  run.publish_standing(0, 1);
  std::jthread program{[&] {
    cuscus::ipc::ChildSession child{std::move(run.program)};
    example::hover(child);
  }};

  CHECK(run.orchestrator.receive().envelope.has_ready());
  run.start();
  // Its first word, by which its motors run: it takes off at once.
  std::string state = run.orchestrator.receive().envelope.status().state();
  run.stop();
  cuscus::ipc::ControlSocket::Received last = run.orchestrator.receive();
  while (last.envelope.has_status()) {
    last = run.orchestrator.receive();
  }

  CHECK(state == "taking-off");
  CHECK(last.envelope.report().agent().loops() > 0);
  CHECK(run.actuators.command().value().motors[0] > 0.0);
  CHECK(run.actuators.command().value().motors[0] <= 1.0);
}

}  // namespace
