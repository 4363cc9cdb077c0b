// Hovers like hover-agent and prints what its camera sees, for camera_test.py.
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

/// "picture NUMBER TIME WIDTH HEIGHT FOCAL px py pz qw qx qy qz HEX": where motion capture had the
/// vehicle then, and all pixels.
void print(const cuscus::sdk::CameraPicture& picture,
           const cuscus::sdk::MotionCaptureReading& place) {
  const auto& p_m = place.p_WB_m;
  const auto& q = place.q_WB;
  std::printf("picture %llu %.6f %u %u %.4f %.4f %.4f %.4f %.6f %.6f %.6f %.6f ",
              static_cast<unsigned long long>(picture.sequence),
              cuscus::to_seconds(picture.time.time_since_epoch()), picture.width_px,
              picture.height_px, picture.focal_px, p_m.x(), p_m.y(), p_m.z(), q.w(), q.x(), q.y(),
              q.z());
  for (const std::byte byte : picture.rgb) {
    std::printf("%02x", std::to_integer<unsigned>(byte));
  }
  std::printf("\n");
}

/// Counts new pictures; prints the first one after `show_s`.
class Viewer {
 public:
  explicit Viewer(double show_s) : show_s_{show_s} {}

  void look(const cuscus::sdk::Sensors& sensors, cuscus::SimTime now) {
    if (sensors.camera_pictures() == seen_) {
      return;
    }
    seen_ = sensors.camera_pictures();
    const auto picture = sensors.camera();
    if (!picture || picture->sequence <= last_) {
      return;
    }
    last_ = picture->sequence;
    ++pictures_;
    if (!shown_ && cuscus::to_seconds(now.time_since_epoch()) >= show_s_) {
      shown_ = true;
      print(*picture, sensors.motion_capture().value());
    }
  }
  void conclude() const {
    std::printf("pictures %llu last %llu\n", static_cast<unsigned long long>(pictures_),
                static_cast<unsigned long long>(last_));
    std::fflush(stdout);
  }

 private:
  double show_s_;
  std::uint64_t seen_{0};
  std::uint64_t last_{0};
  std::uint64_t pictures_{0};
  bool shown_{false};
};

void fly(cuscus::ipc::ChildSession& child) {
  using namespace std::chrono_literals;
  constexpr double kShow_s = 10.0;
  cuscus::sdk::SimSession session{child};
  cuscus::sdk::Vehicle& vehicle = session.vehicle();
  cuscus::flight::Autopilot autopilot{cuscus::flight::Airframe{}};
  cuscus::sdk::PeriodicTimer control{5ms};
  cuscus::sdk::PeriodicTimer beat{250ms};
  Viewer viewer{kShow_s};
  autopilot.take_off(3.0);
  if (session.wait_for_start()) {
    while (!session.stop_requested()) {
      vehicle.clock().sleep_until(control.deadline());
      const cuscus::SimTime now = vehicle.clock().now();
      static_cast<void>(control.advance(now));
      autopilot.sense(now, vehicle.sensors().imu(), vehicle.sensors().motion_capture());
      vehicle.actuators().set_motors(autopilot.act(now, std::nullopt), now);
      viewer.look(vehicle.sensors(), now);
      if (beat.due(now)) {
        beat.advance(now);
        session.beat(std::string{name(autopilot.state())});
      }
    }
  }
  viewer.conclude();
  session.finish({});
}

}  // namespace

int main() {
  try {
    auto child = cuscus::ipc::ChildSession::from_environment();
    fly(child);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "camera-agent: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
