#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>

#include "common/ipc/child_session.h"
#include "uav-agent/flight/autopilot.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/sim/sim_session.h"

namespace {

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

}  // namespace

int main() {
  try {
    auto child = cuscus::ipc::ChildSession::from_environment();
    hover(child);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hover-agent: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
