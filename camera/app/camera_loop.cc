#include "camera/app/camera_loop.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "camera/app/configuration.h"
#include "camera/gl/renderer.h"
#include "camera/gl/surfaceless_context.h"
#include "camera/view/frame_schedule.h"
#include "common/city/transfer/city_message.h"
#include "common/ipc/duration_summary.h"
#include "common/log/log.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/resource_usage.h"
#include "common/posix/scheduling.h"
#include "common/posix/shared_memory.h"
#include "common/statistics/log2_histogram.h"
#include "proto/shm/camera_memory.h"
#include "proto/shm/fleet_memory.h"

namespace cuscus::camera {
namespace {

constexpr std::int64_t kLookPeriod_ns = 20'000'000;
constexpr std::int64_t kBeatPeriod_ns = 500'000'000;

Scene take_scene(ipc::ChildSession& session) {
  const auto memory = session.take_if_given(proto::Descriptors::KIND_CITY);
  if (!memory) {
    return {};
  }
  const auto mapping = posix::MemoryMapping::read_only(*memory);
  return scene_of(city::from_bytes(mapping.bytes()));
}

/// One camera with its memory and its own picture to draw in.
class OneCamera {
 public:
  OneCamera(ipc::ChildSession& session, const proto::CameraNode& from)
      : node_{from.node()},
        pinhole_{pinhole_of(from)},
        mount_{mount_of(from)},
        schedule_{from.period_ns()},
        mapping_{posix::MemoryMapping::read_write(
            session.take(proto::Descriptors::KIND_CAMERA_MEMORY, node_))},
        writer_{mapping_.writable_bytes(), shape_of(pinhole_)},
        rgb_(shape_of(pinhole_).byte_size()) {}

  [[nodiscard]] std::uint32_t node() const { return node_; }
  [[nodiscard]] FrameSchedule& schedule() { return schedule_; }

  /// Makes the picture from where the vehicle is.
  void take(Renderer& renderer, const shm::NodeState& state, std::span<const Body> bodies) {
    const Eigen::Quaterniond q_WB{state.q_WB[0], state.q_WB[1], state.q_WB[2], state.q_WB[3]};
    const CameraPose pose = CameraPose::of({state.p_WB_m[0], state.p_WB_m[1], state.p_WB_m[2]},
                                           q_WB.normalized(), mount_);
    renderer.draw(pinhole_, pose, bodies, rgb_);
    const Eigen::Quaterniond q_WC{pose.R_WC};
    writer_.publish({.sim_time_ns = state.sim_time_ns,
                     .sequence = schedule_.number(),
                     .p_WC_m = {pose.p_WC_m.x(), pose.p_WC_m.y(), pose.p_WC_m.z()},
                     .q_WC = {q_WC.w(), q_WC.x(), q_WC.y(), q_WC.z()}},
                    rgb_);
  }

  void report(proto::CameraTally& tally) const {
    tally.set_node(node_);
    tally.set_pictures(schedule_.made());
    tally.set_late(schedule_.late());
    tally.set_skipped(schedule_.skipped());
  }

 private:
  std::uint32_t node_;
  Pinhole pinhole_;
  CameraMount mount_;
  FrameSchedule schedule_;
  posix::MemoryMapping mapping_;
  shm::CameraMemoryWriter writer_;
  std::vector<std::byte> rgb_;
};

/// All cameras of the run.
class AllCameras {
 public:
  AllCameras(ipc::ChildSession& session, const proto::CameraConfiguration& configuration)
      : session_{session},
        fleet_mapping_{
            posix::MemoryMapping::read_only(session.take(proto::Descriptors::KIND_FLEET_MEMORY))},
        fleet_{fleet_mapping_.bytes()},
        renderer_{take_scene(session)} {
    for (const proto::CameraNode& camera : configuration.cameras()) {
      cameras_.push_back(std::make_unique<OneCamera>(session, camera));
    }
    for (const proto::CameraBody& body : configuration.bodies()) {
      sizes_m_[body.node()] = {body.size_m().x(), body.size_m().y(), body.size_m().z()};
    }
  }

  [[nodiscard]] std::string renderer() const { return context_.renderer(); }

  /// Makes pictures until Stop.
  void run(std::int64_t start_monotonic_ns) {
    start_monotonic_ns_ = start_monotonic_ns;
    while (goes_on()) {
      OneCamera& camera = **std::min_element(
          cameras_.begin(), cameras_.end(), [](const auto& one, const auto& other) {
            return one->schedule().due_ns() < other->schedule().due_ns();
          });
      const std::int64_t due_ns = camera.schedule().due_ns();
      if (now_ns() < due_ns) {
        posix::sleep_until_monotonic(start_monotonic_ns_ +
                                     std::min(due_ns, now_ns() + kLookPeriod_ns));
      }
      if (now_ns() >= due_ns) {
        serve(camera);
      }
    }
  }

  [[nodiscard]] proto::CameraReport report() const {
    proto::CameraReport report;
    report.set_renderer(renderer());
    report.set_scheduler(posix::scheduling_class());
    *report.mutable_drawing() = ipc::summary_of(drawing_);
    report.set_cpu_s(posix::process_cpu_s());
    for (const auto& camera : cameras_) {
      camera->report(*report.add_cameras());
    }
    return report;
  }

 private:
  [[nodiscard]] std::int64_t now_ns() const {
    return posix::monotonic_now_ns() - start_monotonic_ns_;
  }

  bool goes_on() {
    const std::int64_t now = now_ns();
    if (now >= next_beat_ns_) {
      next_beat_ns_ = now + kBeatPeriod_ns;
      proto::Report so_far;
      *so_far.mutable_camera() = report();
      session_.beat(now, so_far);
    }
    return !session_.stop_requested();
  }

  void serve(OneCamera& camera) {
    const std::int64_t begun_ns = now_ns();
    camera.schedule().begin(begun_ns);
    const auto state = fleet_.state(camera.node());
    if (!state) {
      camera.schedule().give_up();
      return;
    }
    camera.take(renderer_, *state, bodies_but(camera.node()));
    const std::int64_t done_ns = now_ns();
    camera.schedule().finish(done_ns);
    drawing_.add(done_ns - begun_ns);
  }

  std::span<const Body> bodies_but(std::uint32_t own) {
    bodies_.clear();
    for (const auto& [node, size_m] : sizes_m_) {
      const auto state = node == own ? std::nullopt : fleet_.state(node);
      if (state) {
        bodies_.push_back(
            {.size_m = size_m,
             .p_WB_m = {state->p_WB_m[0], state->p_WB_m[1], state->p_WB_m[2]},
             .q_WB = {state->q_WB[0], state->q_WB[1], state->q_WB[2], state->q_WB[3]}});
      }
    }
    return bodies_;
  }

  ipc::ChildSession& session_;
  posix::MemoryMapping fleet_mapping_;
  shm::FleetMemoryReader fleet_;
  SurfacelessContext context_;
  Renderer renderer_;
  std::vector<std::unique_ptr<OneCamera>> cameras_;
  std::map<std::uint32_t, Eigen::Vector3d> sizes_m_;
  std::vector<Body> bodies_;
  statistics::Log2Histogram drawing_;
  std::int64_t start_monotonic_ns_{0};
  std::int64_t next_beat_ns_{0};
};

void log_tallies(const proto::CameraReport& report) {
  for (const proto::CameraTally& tally : report.cameras()) {
    if (tally.skipped() + tally.late() != 0) {
      spdlog::warn("camera of node {}: {} pictures, {} of them late, {} skipped", tally.node(),
                   tally.pictures(), tally.late(), tally.skipped());
    }
  }
}

}  // namespace

void run_cameras(ipc::ChildSession& session) {
  const proto::Configure configure = session.await_configuration();
  if (!configure.has_camera()) {
    throw std::invalid_argument{"Configure holds no camera configuration"};
  }
  check_configuration(configure.camera());
  AllCameras cameras{session, configure.camera()};
  session.ready();
  spdlog::info("ready: {} cameras, drawn by {}, {}", configure.camera().cameras_size(),
               cameras.renderer(), posix::scheduling_class());
  if (const auto start_monotonic_ns = session.await_start()) {
    cameras.run(*start_monotonic_ns);
  }
  proto::Report report;
  *report.mutable_camera() = cameras.report();
  log_tallies(report.camera());
  spdlog::info("stopped: a picture took p50 {} us, p99 {} us, max {} us",
               report.camera().drawing().p50_ns() / 1000, report.camera().drawing().p99_ns() / 1000,
               report.camera().drawing().max_ns() / 1000);
  session.report(report);
}

}  // namespace cuscus::camera
