#include "world/app/world_memory.h"

#include "proto/shm/clock_page.h"

namespace cuscus::world {

WorldMemory map_memory(ipc::ChildSession& session, const proto::WorldConfiguration& configuration) {
  using posix::MemoryMapping;
  using proto::Descriptors;
  if (const auto clock_page = session.take_if_given(Descriptors::KIND_CLOCK_PAGE)) {
    // Start brings the same instant; the page is looked at only to refuse another layout.
    const MemoryMapping mapping = MemoryMapping::read_only(*clock_page);
    static_cast<void>(shm::ClockPageReader{mapping.bytes()});
  }
  WorldMemory memory;
  memory.fleet = MemoryMapping::read_write(session.take(Descriptors::KIND_FLEET_MEMORY));
  if (const auto fd = session.take_if_given(Descriptors::KIND_MOTION_CAPTURE_MEMORY)) {
    memory.motion_capture = MemoryMapping::read_write(*fd);
  }
  for (const proto::WorldNode& node : configuration.nodes()) {
    if (node.has_multirotor()) {
      memory.vehicles[node.node()] = {.sensors = MemoryMapping::read_write(session.take(
                                          Descriptors::KIND_SENSOR_MEMORY, node.node())),
                                      .actuators = MemoryMapping::read_only(session.take(
                                          Descriptors::KIND_ACTUATOR_MEMORY, node.node()))};
    }
  }
  return memory;
}

}  // namespace cuscus::world
