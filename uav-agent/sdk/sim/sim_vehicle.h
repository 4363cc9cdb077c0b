#pragma once

#include <cstdint>
#include <optional>

#include "common/posix/shared_memory.h"
#include "proto/shm/camera_memory.h"
#include "proto/shm/clock_page.h"
#include "proto/shm/motion_capture_memory.h"
#include "proto/shm/radio_readings.h"
#include "proto/shm/vehicle_memory.h"
#include "uav-agent/sdk/vehicle.h"

namespace cuscus::sdk {

/// CLOCK_MONOTONIC less the start of the run, which the clock page tells.
class SimulatedClock final : public Clock {
 public:
  explicit SimulatedClock(posix::MemoryMapping page);

  /// The run's beginning (0) as long as it has not begun.
  [[nodiscard]] SimTime now() const override;
  void sleep_until(SimTime instant) const override;

 private:
  posix::MemoryMapping mapping_;
  shm::ClockPageReader page_;
};

/// A vehicle whose sensors and motors are shared memories that the simulated world reads and
/// writes. Mappings are its own; it is used by one thread.
class SimVehicle final : public Vehicle,
                         private Sensors,
                         private Actuators,
                         private FleetMotionCapture,
                         private Radio {
 public:
  struct Memories {
    posix::MemoryMapping clock_page;
    posix::MemoryMapping sensors;
    posix::MemoryMapping actuators;               ///< Writable.
    std::optional<posix::MemoryMapping> fleet{};  ///< Motion capture of all vehicles.
    std::optional<posix::MemoryMapping> radio{};  ///< Without, the radio hears nobody.
    std::optional<posix::MemoryMapping> camera{};
  };

  /// @throws shm::LayoutError when a memory is not what it should be.
  explicit SimVehicle(Memories memories);

  [[nodiscard]] const Clock& clock() const override { return clock_; }
  [[nodiscard]] const Sensors& sensors() const override { return *this; }
  [[nodiscard]] Actuators& actuators() override { return *this; }
  [[nodiscard]] const Radio& radio() const override { return *this; }
  [[nodiscard]] const FleetMotionCapture* fleet() const override {
    return fleet_reader_ ? this : nullptr;
  }

 private:
  [[nodiscard]] std::optional<ImuReading> imu() const override;
  [[nodiscard]] std::optional<MotionCaptureReading> motion_capture() const override;
  [[nodiscard]] std::optional<UltrasonicReading> ultrasonic() const override;
  [[nodiscard]] std::optional<LidarScan> lidar() const override;
  [[nodiscard]] std::optional<GnssReading> gnss() const override;
  [[nodiscard]] std::optional<CameraPicture> camera() const override;
  [[nodiscard]] std::uint64_t camera_pictures() const override;
  [[nodiscard]] std::optional<MotionCaptureReading> motion_capture_of(
      std::uint32_t node) const override;
  [[nodiscard]] std::vector<Neighbour> neighbours() const override;
  [[nodiscard]] std::optional<Decibel> link_budget(std::uint32_t node) const override;
  void set_motors(const MotorCommands& commands, SimTime now) override;

  SimulatedClock clock_;
  posix::MemoryMapping sensor_mapping_;
  posix::MemoryMapping actuator_mapping_;
  std::optional<posix::MemoryMapping> fleet_mapping_;
  std::optional<posix::MemoryMapping> radio_mapping_;
  std::optional<posix::MemoryMapping> camera_mapping_;
  shm::SensorMemoryReader sensor_reader_;
  shm::ActuatorMemoryWriter actuator_writer_;
  std::optional<shm::MotionCaptureMemoryReader> fleet_reader_;
  std::optional<shm::RadioReadingsReader> radio_reader_;
  std::optional<shm::CameraMemoryReader> camera_reader_;
  std::uint64_t command_sequence_ = 0;
};

}  // namespace cuscus::sdk
