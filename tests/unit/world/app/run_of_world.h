#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/ipc/child_session.h"
#include "common/posix/shared_memory.h"
#include "proto/configuration.pb.h"
#include "proto/shm/clock_page.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/vehicle_memory.h"
#include "world/app/world_memory.h"

namespace cuscus::world {

/// FL-AIR's X4 as a message.
inline proto::MultirotorParameters x4_message() {
  proto::MultirotorParameters x4;
  x4.set_source("FL-AIR simulator_x4.xml");
  x4.set_mass_kg(1.2);
  x4.set_arm_m(0.2);
  x4.set_thrust_factor(0.001);
  x4.set_torque_factor(0.001);
  x4.set_drag_vertical(0.01);
  x4.set_drag_lateral(0.4);
  x4.set_inertia_roll_kgm2(0.006);
  x4.set_inertia_pitch_kgm2(0.006);
  x4.set_inertia_yaw_kgm2(0.1);
  x4.set_motor_speed_per_command(86.0);
  x4.set_motor_timeout_ns(100'000'000);
  return x4;
}

/// `vehicles` X4, nodes 0 ... vehicles - 1, 10 m apart on the ground.
inline proto::WorldConfiguration fleet_configuration(std::uint32_t vehicles) {
  proto::WorldConfiguration configuration;
  configuration.set_seed(11);
  configuration.set_step_ns(1'000'000);
  configuration.set_gravity_mps2(9.81);
  configuration.set_imu_period_ns(5'000'000);
  configuration.set_gyro_noise_radps(0.01);
  configuration.set_accelerometer_noise_mps2(0.1);
  configuration.set_motion_capture_period_ns(10'000'000);
  configuration.set_motion_capture_noise_m(0.001);
  configuration.set_motion_capture_noise_rad(0.002);
  for (std::uint32_t i = 0; i < vehicles; ++i) {
    proto::WorldNode& node = *configuration.add_nodes();
    node.set_node(i);
    node.set_name("uav" + std::to_string(i));
    node.mutable_p_wb_start_m()->set_x(10.0 * i);
    node.set_yaw_start_rad(0.5);
    *node.mutable_multirotor() = x4_message();
  }
  return configuration;
}

/// The orchestrator's, the agents' and the readers' side of a run: it owns the memories.
class RunOfWorld {
 public:
  RunOfWorld(std::uint32_t nodes, const std::vector<std::uint32_t>& vehicles,
             bool with_lidar = false)
      : fleet_{posix::create_shared_memory("fleet", shm::FleetMemoryWriter::byte_size(nodes))},
        motion_capture_{posix::create_shared_memory(
            "motion-capture", shm::MotionCaptureMemoryWriter::byte_size(nodes))} {
    for (const std::uint32_t node : vehicles) {
      Vehicle vehicle{
          .sensors =
              posix::create_shared_memory("s", shm::SensorMemoryWriter::byte_size(with_lidar)),
          .actuators = posix::create_shared_memory("a", shm::ActuatorMemoryWriter::byte_size()),
          .agent = {}};
      vehicle.agent = posix::MemoryMapping::read_write(vehicle.actuators);
      shm::ActuatorMemoryWriter::lay_out(vehicle.agent.writable_bytes());
      vehicles_.emplace(node, std::move(vehicle));
    }
  }

  /// What the world would map from the descriptors.
  [[nodiscard]] WorldMemory map() const {
    WorldMemory memory;
    memory.fleet = posix::MemoryMapping::read_write(fleet_);
    memory.motion_capture = posix::MemoryMapping::read_write(motion_capture_);
    for (const auto& [node, vehicle] : vehicles_) {
      memory.vehicles[node] = {.sensors = posix::MemoryMapping::read_write(vehicle.sensors),
                               .actuators = posix::MemoryMapping::read_only(vehicle.actuators)};
    }
    return memory;
  }

  void send_descriptors(ipc::ControlSocket& socket) const {
    send(socket, proto::Descriptors::KIND_FLEET_MEMORY, 0, fleet_);
    send(socket, proto::Descriptors::KIND_MOTION_CAPTURE_MEMORY, 0, motion_capture_);
    for (const auto& [node, vehicle] : vehicles_) {
      send(socket, proto::Descriptors::KIND_SENSOR_MEMORY, node, vehicle.sensors);
      send(socket, proto::Descriptors::KIND_ACTUATOR_MEMORY, node, vehicle.actuators);
    }
  }

  /// Plays the agent of `node`.
  void command(std::uint32_t node, std::uint64_t sequence, const std::array<double, 8>& motors) {
    shm::ActuatorMemoryWriter{vehicles_.at(node).agent.writable_bytes()}.publish(
        {.sim_time_ns = 0, .sequence = sequence, .motors = motors});
  }

  /// The bytes that the agent of `node` may write, for one that does not keep to the layout.
  [[nodiscard]] std::span<std::byte> actuator_bytes(std::uint32_t node) {
    return vehicles_.at(node).agent.writable_bytes();
  }

  [[nodiscard]] posix::MemoryMapping map_fleet() const {
    return posix::MemoryMapping::read_only(fleet_);
  }
  [[nodiscard]] posix::MemoryMapping map_motion_capture() const {
    return posix::MemoryMapping::read_only(motion_capture_);
  }
  [[nodiscard]] posix::MemoryMapping map_sensors(std::uint32_t node) const {
    return posix::MemoryMapping::read_only(vehicles_.at(node).sensors);
  }

 private:
  struct Vehicle {
    posix::UniqueFd sensors;
    posix::UniqueFd actuators;
    posix::MemoryMapping agent;
  };

  static void send(ipc::ControlSocket& socket, proto::Descriptors::Kind kind, std::uint32_t node,
                   const posix::UniqueFd& fd) {
    proto::Envelope envelope;
    auto* const item = envelope.mutable_descriptors()->add_items();
    item->set_kind(kind);
    item->set_node(node);
    socket.send(envelope, std::array{fd.get()});
  }

  posix::UniqueFd fleet_;
  posix::UniqueFd motion_capture_;
  std::map<std::uint32_t, Vehicle> vehicles_;
};

}  // namespace cuscus::world
