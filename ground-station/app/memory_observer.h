#pragma once

#include "common/posix/shared_memory.h"
#include "ground-station/core/snapshot.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::gcs {

/// Reads fleet and radio memory.
class MemoryObserver {
 public:
  /// @throws std::system_error or shm::LayoutError when a memory is not what it should be.
  MemoryObserver(const posix::UniqueFd& fleet, const posix::UniqueFd& radio);

  [[nodiscard]] Observation observe() const;

 private:
  posix::MemoryMapping fleet_mapping_;
  posix::MemoryMapping radio_mapping_;
  shm::FleetMemoryReader fleet_;
  shm::RadioMemoryReader radio_;
};

}  // namespace cuscus::gcs
