#include "orchestrator/app/run_memories.h"

#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/radio_readings.h"
#include "proto/shm/vehicle_memory.h"

namespace cuscus::orchestrator {

using posix::create_shared_memory;
using posix::MemoryMapping;
using posix::seal_against_new_writers;

RunMemories::RunMemories(std::uint32_t node_count, const std::vector<VehicleNode>& vehicles)
    : clock_{create_shared_memory("cuscus-clock", shm::ClockPageWriter::byte_size())},
      clock_mapping_{MemoryMapping::read_write(clock_)},
      clock_writer_{clock_mapping_.writable_bytes()},
      fleet_{create_shared_memory("cuscus-fleet", shm::FleetMemoryWriter::byte_size(node_count))},
      radio_{create_shared_memory("cuscus-radio", shm::RadioMemoryWriter::byte_size(node_count))},
      motion_capture_{create_shared_memory("cuscus-motion-capture",
                                           shm::MotionCaptureMemoryWriter::byte_size(node_count))} {
  seal_against_new_writers(clock_);
  for (const auto& [node, has_lidar, pictures] : vehicles) {
    sensors_[node] =
        create_shared_memory("cuscus-sensors", shm::SensorMemoryWriter::byte_size(has_lidar));
    radio_readings_[node] = create_shared_memory("cuscus-radio-readings",
                                                 shm::RadioReadingsWriter::byte_size(node_count));
    if (pictures) {
      cameras_[node] =
          create_shared_memory("cuscus-camera", shm::CameraMemoryWriter::byte_size(*pictures));
    }
    auto& actuators = actuators_[node] =
        create_shared_memory("cuscus-actuators", shm::ActuatorMemoryWriter::byte_size());
    shm::ActuatorMemoryWriter::lay_out(MemoryMapping::read_write(actuators).writable_bytes());
  }
}

void RunMemories::world_has_mapped() {
  seal_against_new_writers(fleet_);
  seal_against_new_writers(motion_capture_);
  for (const auto& [node, memory] : sensors_) {
    seal_against_new_writers(memory);
  }
  fleet_mapping_ = MemoryMapping::read_only(fleet_);
  fleet_reader_.emplace(fleet_mapping_.bytes());
}

void RunMemories::camera_has_mapped() {
  for (const auto& [node, memory] : cameras_) {
    seal_against_new_writers(memory);
  }
}

void RunMemories::netsim_has_mapped() {
  seal_against_new_writers(radio_);
  for (const auto& [node, memory] : radio_readings_) {
    seal_against_new_writers(memory);
  }
  radio_mapping_ = MemoryMapping::read_only(radio_);
  radio_reader_.emplace(radio_mapping_.bytes());
}

}  // namespace cuscus::orchestrator
