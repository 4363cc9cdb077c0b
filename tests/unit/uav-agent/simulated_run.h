#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/ipc/child_session.h"
#include "common/ipc/control_socket.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/shared_memory.h"
#include "proto/control.pb.h"
#include "proto/shm/camera_memory.h"
#include "proto/shm/clock_page.h"
#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/radio_readings.h"
#include "proto/shm/vehicle_memory.h"

namespace cuscus::tests {

/// The orchestrator's and the world's side of one flying program: memories and control socket.
class SimulatedRun {
 public:
  static constexpr std::uint32_t kNode = 2;
  static constexpr std::uint32_t kNodes = 4;
  static constexpr shm::PictureShape kPictures{.width_px = 20, .height_px = 16, .focal_px = 12.5};

  /// Sends descriptors and `configuration`.
  void configure(const proto::AgentConfiguration& configuration, bool with_fleet = true) {
    using proto::Descriptors;
    proto::Envelope envelope;
    auto* const items = envelope.mutable_descriptors();
    const auto name = [&](Descriptors::Kind kind, std::uint32_t node) {
      auto* const item = items->add_items();
      item->set_kind(kind);
      item->set_node(node);
    };
    name(Descriptors::KIND_CLOCK_PAGE, 0);
    name(Descriptors::KIND_SENSOR_MEMORY, kNode);
    name(Descriptors::KIND_ACTUATOR_MEMORY, kNode);
    name(Descriptors::KIND_RADIO_READINGS, kNode);
    name(Descriptors::KIND_CAMERA_MEMORY, kNode);
    name(Descriptors::KIND_MOTION_CAPTURE_MEMORY, 0);
    const std::array fds{clock_fd_.get(), sensor_fd_.get(), actuator_fd_.get(),
                         radio_fd_.get(), camera_fd_.get(), fleet_fd_.get()};
    if (with_fleet) {
      orchestrator.send(envelope, fds);
    } else {
      items->mutable_items()->RemoveLast();
      orchestrator.send(envelope, std::span{fds}.first(5));
    }
    proto::Envelope configure;
    *configure.mutable_configure()->mutable_agent() = configuration;
    orchestrator.send(configure);
  }

  void start() {
    const std::int64_t now_ns = posix::monotonic_now_ns();
    clock.start(now_ns);
    proto::Envelope envelope;
    envelope.mutable_start()->set_start_monotonic_ns(now_ns);
    orchestrator.send(envelope);
  }

  void stop() {
    proto::Envelope envelope;
    envelope.mutable_stop();
    orchestrator.send(envelope);
  }

  /// Lets both sensors say that the vehicle stands at the origin.
  void publish_standing(std::int64_t sim_time_ns, std::uint64_t sequence) {
    sensors.publish(shm::ImuReading{.sim_time_ns = sim_time_ns,
                                    .sequence = sequence,
                                    .angular_rate_B_radps = {},
                                    .specific_force_B_mps2 = {0.0, 0.0, 9.81}});
    sensors.publish(shm::MotionCaptureReading{.sim_time_ns = sim_time_ns,
                                              .sequence = sequence,
                                              .p_WB_m = {},
                                              .q_WB = {1.0, 0.0, 0.0, 0.0}});
  }

 private:
  static posix::MemoryMapping laid_out(const posix::UniqueFd& fd) {
    auto mapping = posix::MemoryMapping::read_write(fd);
    shm::ActuatorMemoryWriter::lay_out(mapping.writable_bytes());
    return mapping;
  }

  std::pair<ipc::ControlSocket, ipc::ControlSocket> sockets_ = ipc::ControlSocket::pair();
  posix::UniqueFd clock_fd_ =
      posix::create_shared_memory("clock", shm::ClockPageWriter::byte_size());
  posix::UniqueFd sensor_fd_ =
      posix::create_shared_memory("sensors", shm::SensorMemoryWriter::byte_size(true));
  posix::UniqueFd actuator_fd_ =
      posix::create_shared_memory("actuators", shm::ActuatorMemoryWriter::byte_size());
  posix::UniqueFd fleet_fd_ =
      posix::create_shared_memory("fleet", shm::MotionCaptureMemoryWriter::byte_size(kNodes));
  posix::UniqueFd radio_fd_ =
      posix::create_shared_memory("radio", shm::RadioReadingsWriter::byte_size(kNodes));
  posix::UniqueFd camera_fd_ =
      posix::create_shared_memory("camera", shm::CameraMemoryWriter::byte_size(kPictures));
  posix::MemoryMapping clock_map_ = posix::MemoryMapping::read_write(clock_fd_);
  posix::MemoryMapping sensor_map_ = posix::MemoryMapping::read_write(sensor_fd_);
  posix::MemoryMapping actuator_map_ = laid_out(actuator_fd_);
  posix::MemoryMapping fleet_map_ = posix::MemoryMapping::read_write(fleet_fd_);
  posix::MemoryMapping radio_map_ = posix::MemoryMapping::read_write(radio_fd_);
  posix::MemoryMapping camera_map_ = posix::MemoryMapping::read_write(camera_fd_);

 public:
  ipc::ControlSocket& orchestrator = sockets_.first;
  /// The program's end; to be moved out.
  ipc::ControlSocket& program = sockets_.second;
  shm::ClockPageWriter clock{clock_map_.writable_bytes()};
  shm::SensorMemoryWriter sensors{sensor_map_.writable_bytes()};
  shm::MotionCaptureMemoryWriter fleet{fleet_map_.writable_bytes(), kNodes};
  /// Its threshold is -82 dBm.
  shm::RadioReadingsWriter radio{radio_map_.writable_bytes(), kNodes, -82.0F};
  shm::CameraMemoryWriter camera{camera_map_.writable_bytes(), kPictures};
  shm::ActuatorMemoryReader actuators{actuator_map_.bytes()};
};

}  // namespace cuscus::tests
