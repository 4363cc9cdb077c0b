#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/posix/shared_memory.h"
#include "common/posix/unique_fd.h"
#include "proto/shm/camera_memory.h"
#include "proto/shm/clock_page.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::orchestrator {

/// Every shared memory of one run. The orchestrator makes them and lays out those that have no
/// single writer of ours; world and netsim lay out their own.
class RunMemories {
 public:
  struct VehicleNode {
    std::uint32_t node;
    bool has_lidar;
    std::optional<shm::PictureShape> pictures{};  ///< Of its camera, if it has one.
  };

  /// For nodes 0 ... node_count - 1, of which `vehicles` have sensors and actuators.
  RunMemories(std::uint32_t node_count, const std::vector<VehicleNode>& vehicles);

  [[nodiscard]] int clock() const noexcept { return clock_.get(); }
  [[nodiscard]] int fleet() const noexcept { return fleet_.get(); }
  [[nodiscard]] int radio() const noexcept { return radio_.get(); }
  [[nodiscard]] int motion_capture() const noexcept { return motion_capture_.get(); }
  [[nodiscard]] int sensors(std::uint32_t node) const { return sensors_.at(node).get(); }
  [[nodiscard]] int radio_readings(std::uint32_t node) const {
    return radio_readings_.at(node).get();
  }
  /// -1: it has none.
  [[nodiscard]] int camera(std::uint32_t node) const {
    const auto found = cameras_.find(node);
    return found == cameras_.end() ? -1 : found->second.get();
  }
  [[nodiscard]] int actuators(std::uint32_t node) const { return actuators_.at(node).get(); }

  /// Sets SimTime 0.
  void start(std::int64_t monotonic_ns) noexcept { clock_writer_->start(monotonic_ns); }

  /// The world is ready: from now on nobody else can come to write what it writes.
  void world_has_mapped();
  /// Likewise cuscus-camera.
  void camera_has_mapped();
  /// Likewise netsim.
  void netsim_has_mapped();

  /// Nothing before world_has_mapped() or netsim_has_mapped().
  [[nodiscard]] const std::optional<shm::FleetMemoryReader>& fleet_reader() const {
    return fleet_reader_;
  }
  [[nodiscard]] const std::optional<shm::RadioMemoryReader>& radio_reader() const {
    return radio_reader_;
  }

 private:
  posix::UniqueFd clock_;
  posix::MemoryMapping clock_mapping_;
  std::optional<shm::ClockPageWriter> clock_writer_;
  posix::UniqueFd fleet_;
  posix::UniqueFd radio_;
  posix::UniqueFd motion_capture_;
  std::map<std::uint32_t, posix::UniqueFd> sensors_;
  std::map<std::uint32_t, posix::UniqueFd> actuators_;
  std::map<std::uint32_t, posix::UniqueFd> radio_readings_;
  std::map<std::uint32_t, posix::UniqueFd> cameras_;
  posix::MemoryMapping fleet_mapping_;
  posix::MemoryMapping radio_mapping_;
  std::optional<shm::FleetMemoryReader> fleet_reader_;
  std::optional<shm::RadioMemoryReader> radio_reader_;
};

}  // namespace cuscus::orchestrator
