#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "uav-agent/flight/autopilot.h"
#include "uav-agent/missions/circle_mission.h"
#include "uav-agent/missions/neighbour_table.h"
#include "world/dynamics/quadrotor_fleet.h"
#include "world/sensors/imu.h"
#include "world/sensors/motion_capture.h"

namespace cuscus::tests {

/// Real plants, sensors and autopilots, stepped in simulated time: 1 kHz plant, 200 Hz IMU, 100 Hz
/// motion capture, 200 Hz control with its own phase for each vehicle.
class FlightRig {
 public:
  struct Settings {
    std::uint64_t seed = 1;
    std::vector<double> masses_kg{1.2};  ///< Of the plants, one per vehicle.
    std::optional<double>
        nominal_mass_kg{};  ///< What the control laws believe; default: the truth.
    double position_noise_m = 0.001;
    double attitude_noise_rad = 0.001;
    double gyro_noise_radps = 0.01;
    double accelerometer_noise_mps2 = 0.1;
    std::vector<Eigen::Vector3d> p_WB_start_m{Eigen::Vector3d::Zero()};
  };

  /// What a vehicle is to do at an instant of flight.
  using Guidance = std::function<flight::Setpoint(std::size_t vehicle, SimTime now)>;

  explicit FlightRig(const Settings& settings);

  /// Advances by one millisecond. `guidance` is asked in every control period while flying.
  void step(const Guidance& guidance);

  [[nodiscard]] SimTime now() const { return now_; }
  [[nodiscard]] std::size_t size() const { return pilots_.size(); }
  [[nodiscard]] world::RigidBodyState truth(std::size_t vehicle) const {
    return plant_->state(vehicle);
  }
  [[nodiscard]] bool on_ground(std::size_t vehicle) const { return plant_->on_ground(vehicle); }
  [[nodiscard]] flight::Autopilot& pilot(std::size_t vehicle) { return pilots_[vehicle]; }
  [[nodiscard]] const std::optional<flight::MotionCaptureReading>& capture(
      std::size_t vehicle) const {
    return sensors_[vehicle].capture;
  }

  /// From now on the sensor is silent, or speaks again.
  void silence_motion_capture(std::size_t vehicle, bool silent) {
    sensors_[vehicle].capture_silent = silent;
  }
  void silence_imu(std::size_t vehicle, bool silent) { sensors_[vehicle].imu_silent = silent; }

 private:
  struct SensorSet {
    world::Imu imu;
    world::MotionCapture motion_capture;
    std::optional<flight::ImuReading> inertial{};
    std::optional<flight::MotionCaptureReading> capture{};
    bool capture_silent = false;
    bool imu_silent = false;
  };

  void read_sensors();

  std::unique_ptr<world::QuadrotorFleet> plant_;
  std::vector<SensorSet> sensors_;
  std::vector<flight::Autopilot> pilots_;
  std::uint64_t milliseconds_ = 0;
  SimTime now_;
};

/// The circle mission of a fleet on a FlightRig, with neighbours known by motion capture or by
/// beacons over an ideal air of constant delay.
class CircleFleet {
 public:
  struct Settings {
    std::uint32_t fleet_size = 10;
    missions::CircleParameters circle{.p_WC_centre_m = {0.0, 0.0, 10.0}};
    std::uint64_t seed = 1;
    double mass_kg = 1.2;
    std::optional<double> nominal_mass_kg{};
    /// Nothing: motion capture.
    std::optional<SimClock::duration> beacon_period{};
    SimClock::duration beacon_delay = std::chrono::milliseconds{1};
    double beacon_loss = 0.0;  ///< Share of receptions lost, independently.
    SimClock::duration neighbour_timeout = std::chrono::seconds{3};
    double start_scatter_m = 1.0;  ///< Of the start positions around the slots, each axis.
  };

  explicit CircleFleet(const Settings& settings);

  /// Flies until `seconds` after the start; `observe` is called every 10 ms.
  void fly_until(double seconds, const std::function<void()>& observe = {});

  /// Distance of each vehicle from its place: n evenly spaced points on the circle, whose common
  /// phase is the circular mean of (theta_i - 2 pi i / n).
  [[nodiscard]] std::vector<double> formation_errors_m() const;

  /// Distance from the circle, in the plane and in altitude, of each vehicle.
  [[nodiscard]] std::vector<double> radial_errors_m() const;

  /// The least distance between any two.
  [[nodiscard]] double closest_pair_m() const;

  [[nodiscard]] FlightRig& rig() { return rig_; }
  [[nodiscard]] bool all_circling() const;

 private:
  struct InFlight {
    SimTime arrival;
    missions::NeighbourReport report;
  };

  [[nodiscard]] flight::Setpoint guide(std::size_t vehicle, SimTime now);
  void send_beacons();
  void deliver_beacons();
  void look_at_fleet(std::size_t vehicle, SimTime now);

  Settings settings_;
  FlightRig rig_;
  std::vector<missions::CircleMission> missions_;
  std::vector<missions::NeighbourTable> tables_;
  std::vector<SimTime> next_beacon_;
  std::vector<std::uint32_t> sequences_;
  std::vector<InFlight> in_flight_;
  std::uint64_t losses_drawn_ = 0;
};

}  // namespace cuscus::tests
