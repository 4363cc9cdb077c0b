#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/units/sim_time.h"
#include "proto/configuration.pb.h"
#include "proto/report.pb.h"
#include "proto/shm/fleet_memory.h"
#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/vehicle_memory.h"
#include "world/actuation/command_gate.h"
#include "world/app/fleet_collisions.h"
#include "world/app/run_city.h"
#include "world/app/schedule.h"
#include "world/app/view_sensors.h"
#include "world/app/world_memory.h"
#include "world/dynamics/plant.h"
#include "world/sensors/imu.h"
#include "world/sensors/motion_capture.h"

namespace cuscus::world {

/// The fleet of a run between its shared memories: commands in, truth and sensors out. It knows no
/// clock; each step() is the next instant. No step makes a system call, or allocates but where
/// vehicles come close together.
class FleetSimulation {
 public:
  /// Lays out fleet, sensor and motion-capture memory and publishes every node where it starts:
  /// vehicles with stopped motors, standing if they start on something. `city`, which must outlive
  /// this, is what they fly in; null: the bare ground z = 0.
  /// @throws std::invalid_argument when `configuration` or the size of a memory is wrong, or a
  /// vehicle would start in something.
  FleetSimulation(const proto::WorldConfiguration& configuration, WorldMemory memory,
                  const RunCity* city = nullptr);

  /// Publishes the first sensor readings, at SimTime 0, and looks at the commands for the first
  /// time.
  void begin();

  /// Advances to the next instant: moves every vehicle under the commands in force, publishes where
  /// it is and what its sensors say, then takes up the commands that have come meanwhile.
  void step();

  /// What the orchestrator reads to see that the world is alive.
  void publish_progress(std::uint64_t overruns) noexcept;

  /// Publishes the command tallies that have changed; steps do so ten times a second.
  void publish_tallies() noexcept;

  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] SimTime time() const {
    return sim_time(static_cast<std::int64_t>(steps_) * step_ns_);
  }
  [[nodiscard]] SimClock::duration step_length() const { return SimClock::duration{step_ns_}; }

  struct NodeTally {
    std::string name;
    shm::CommandTally commands;
  };
  /// What was made of each vehicle's commands so far.
  [[nodiscard]] std::vector<NodeTally> tallies() const;
  /// First contacts of the latest step, and the counts of all so far.
  [[nodiscard]] const FleetCollisions& collisions() const { return *collisions_; }

 private:
  struct Vehicle {
    std::uint32_t node;
    std::string name;
    Plant* plant;
    std::size_t index;   // in the plant
    std::size_t member;  // of collisions_
    CommandGate gate;
    shm::SensorMemoryWriter sensors;
    shm::ActuatorMemoryReader actuators;
    std::uint64_t seen_version;
    std::uint64_t published_tally;
    Imu imu;
    MotionCapture motion_capture;
  };
  struct FixedNode {
    std::uint32_t node;
    shm::NodeState state;
  };
  struct View {
    std::size_t member;  // of collisions_
    ViewSensors sensors;
  };

  void add_vehicles(const proto::WorldConfiguration& configuration,
                    const Surroundings& surroundings,
                    std::vector<FleetCollisions::Member>& members);
  void publish_state(const Vehicle& vehicle) noexcept;
  void add_views(const proto::WorldConfiguration& configuration, const RunCity* city);
  void publish_fixed_nodes() noexcept;
  void publish_motion_capture(Vehicle& vehicle, const RigidBodyState& body, std::uint64_t reading);
  void publish_imu(Vehicle& vehicle, const RigidBodyState& body, std::uint64_t reading);
  void publish_readings();
  void take_up_commands(Vehicle& vehicle);

  std::int64_t step_ns_;
  std::uint64_t steps_{0};
  WorldMemory memory_;
  std::uint32_t slots_;
  shm::FleetMemoryWriter fleet_;
  std::optional<shm::MotionCaptureMemoryWriter> fleet_motion_capture_;
  std::vector<std::unique_ptr<Plant>> plants_;
  std::vector<Vehicle> vehicles_;
  std::optional<FleetCollisions> collisions_;  // after the plants, which it moves
  std::vector<View> views_;  // of the vehicles that have any; write to their sensors
  std::vector<FixedNode> fixed_nodes_;
  Schedule imu_schedule_;
  Schedule motion_capture_schedule_;
};

}  // namespace cuscus::world
