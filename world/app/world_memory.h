#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "common/ipc/child_session.h"
#include "common/posix/shared_memory.h"
#include "proto/configuration.pb.h"

namespace cuscus::world {

/// The shared memories of a run, as the world maps them.
struct WorldMemory {
  struct Vehicle {
    posix::MemoryMapping sensors;    ///< Writable.
    posix::MemoryMapping actuators;  ///< Read-only.
  };

  posix::MemoryMapping fleet;                          ///< Writable.
  std::optional<posix::MemoryMapping> motion_capture;  ///< Writable.
  std::map<std::uint32_t, Vehicle> vehicles;           ///< By node.
};

/// Maps what the orchestrator gave `session` for `configuration`, and closes the descriptors.
/// @throws ipc::PeerError when one is missing, shm::LayoutError when the clock page is none.
[[nodiscard]] WorldMemory map_memory(ipc::ChildSession& session,
                                     const proto::WorldConfiguration& configuration);

}  // namespace cuscus::world
