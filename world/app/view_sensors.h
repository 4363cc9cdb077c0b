#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/city/import/local_frame.h"
#include "common/units/sim_time.h"
#include "proto/configuration.pb.h"
#include "proto/shm/vehicle_memory.h"
#include "world/app/schedule.h"
#include "world/dynamics/plant.h"
#include "world/sensors/gnss.h"
#include "world/sensors/lidar.h"
#include "world/sensors/ultrasonic.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

/// The sensors of one vehicle that see its surroundings: those that it has, each at its rate.
class ViewSensors {
 public:
  /// What there is to see, where on Earth, and since when.
  struct Place {
    Surroundings surroundings;
    city::Geodetic origin;
    std::chrono::sys_seconds epoch;
  };

  /// Of `node`; writes to `memory`, which must outlive this.
  ViewSensors(std::uint64_t seed, const proto::WorldNode& node, const Place& place,
              shm::SensorMemoryWriter& memory);

  /// Whether `node` has any.
  [[nodiscard]] static bool has_any(const proto::WorldNode& node) {
    return node.has_ultrasonic() || node.has_lidar() || node.has_gnss();
  }

  /// Publishes the readings that are due, of a vehicle at `body`.
  void publish(const RigidBodyState& body, SimTime now);

 private:
  struct TimedUltrasonic {
    Ultrasonic sensor;
    Schedule schedule;
  };
  struct TimedLidar {
    Lidar sensor;
    Schedule schedule;
    shm::LidarScan scan;  // what all scans have in common, filled in
  };

  struct TimedGnss {
    Gnss sensor;
    Schedule schedule;
    city::LocalFrame frame;
  };

  void publish_gnss(const RigidBodyState& body, SimTime now, std::uint64_t reading);

  Surroundings surroundings_;
  shm::SensorMemoryWriter* memory_;
  std::optional<TimedUltrasonic> ultrasonic_;
  std::unique_ptr<TimedLidar> lidar_;  // 17 kB
  std::optional<TimedGnss> gnss_;
};

}  // namespace cuscus::world
