#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/ipc/child_session.h"
#include "uav-agent/flight/autopilot.h"
#include "uav-agent/flight/trapezoid_profile.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/sim/sim_session.h"

namespace {

using namespace cuscus;  // NOLINT(google-build-using-namespace): a main

double number_of(const std::string& text) {
  std::size_t read = 0;
  const double value = std::stod(text, &read);
  if (read != text.size()) {
    throw std::invalid_argument{"'" + text + "' is not a number"};
  }
  return value;
}

/// Straight from point to point, at rest at each.
class Path {
 public:
  /// The speed, then east, north and up of every point: one argument each.
  explicit Path(const std::vector<std::string>& arguments) {
    if (arguments.size() < 4 || arguments.size() % 3 != 1) {
      throw std::invalid_argument{"usage: path-agent SPEED EAST NORTH UP [EAST NORTH UP]..."};
    }
    speed_mps_ = number_of(arguments[0]);
    for (std::size_t i = 1; i < arguments.size(); i += 3) {
      points_.emplace_back(number_of(arguments[i]), number_of(arguments[i + 1]),
                           number_of(arguments[i + 2]));
    }
  }

  [[nodiscard]] const Eigen::Vector3d& first() const { return points_.front(); }

  [[nodiscard]] flight::Setpoint at(double elapsed_s, double yaw_rad) const {
    constexpr double kAcceleration_mps2 = 2.0;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Eigen::Vector3d way_m = points_[i] - points_[i - 1];
      const flight::TrapezoidProfile leg{0.0, way_m.norm(), speed_mps_, kAcceleration_mps2};
      if (elapsed_s < leg.duration_s()) {
        const auto [position_m, velocity_mps, acceleration_mps2] = leg.at(elapsed_s);
        const Eigen::Vector3d along = way_m.normalized();
        return {.p_WB_m = points_[i - 1] + position_m * along,
                .v_WB_mps = velocity_mps * along,
                .a_WB_mps2 = acceleration_mps2 * along,
                .yaw_rad = yaw_rad};
      }
      elapsed_s -= leg.duration_s();
    }
    return {.p_WB_m = points_.back(), .yaw_rad = yaw_rad};
  }

 private:
  double speed_mps_{0.0};
  std::vector<Eigen::Vector3d> points_;
};

/// Takes off below the first point, which should be above where the vehicle stands, and flies.
void fly(ipc::ChildSession& child, const Path& path) {
  using namespace std::chrono_literals;
  sdk::SimSession session{child};
  sdk::Vehicle& vehicle = session.vehicle();
  flight::Autopilot autopilot{flight::Airframe{}};
  sdk::PeriodicTimer control{5ms};
  sdk::PeriodicTimer beat{250ms};
  proto::AgentReport report;
  std::optional<SimTime> began;
  autopilot.take_off(path.first().z());
  if (session.wait_for_start()) {
    while (!session.stop_requested()) {
      vehicle.clock().sleep_until(control.deadline());
      const SimTime now = vehicle.clock().now();
      report.set_overruns(report.overruns() + control.advance(now));
      report.set_loops(report.loops() + 1);
      autopilot.sense(now, vehicle.sensors().imu(), vehicle.sensors().motion_capture());
      std::optional<flight::Setpoint> setpoint;
      if (autopilot.state() == flight::FlightState::kFlying) {
        began = began.value_or(now);
        setpoint = path.at(to_seconds(now - *began), autopilot.heading_rad());
      }
      vehicle.actuators().set_motors(autopilot.act(now, setpoint), now);
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

int main(int argc, char** argv) {
  try {
    const Path path{std::vector<std::string>(argv + 1, argv + argc)};
    auto child = ipc::ChildSession::from_environment();
    fly(child, path);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "path-agent: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
