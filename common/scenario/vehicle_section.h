#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "common/units/sim_time.h"

namespace cuscus::scenario {

enum class CollisionBehaviour { kStop, kBounce, kCrash };

/// What becomes of a vehicle that touches something.
struct Collision {
  CollisionBehaviour behaviour{CollisionBehaviour::kStop};
  double restitution{0.3};  ///< Of kBounce: speed after over speed before.
  double radius_m{0.3};     ///< Of the ball that stands on its position.
};

enum class SensorDirection { kDown, kUp, kForward, kBackward, kLeft, kRight };

/// A rangefinder with a cone; defaults are FL-AIR's, beam and noise ours.
struct UltrasonicSensor {
  SimClock::duration period{std::chrono::milliseconds{20}};
  double range_m{6.0};
  double beam_rad{0.5235987755982988};  ///< Of the whole cone: 30 degrees.
  double noise_m{0.01};                 ///< Standard deviation per reading.
  SensorDirection direction{SensorDirection::kDown};
};

inline constexpr std::uint32_t kMaxLidarRays = 4096;  ///< Of a scan.
inline constexpr std::uint32_t kMaxLidarRows = 128;

struct LidarSensor {
  SimClock::duration period{std::chrono::milliseconds{100}};
  double range_m{30.0};
  double field_rad{6.283185307179586};    ///< Azimuths of a row, around ahead.
  std::uint32_t rays{360};                ///< Of one row.
  std::vector<double> elevations_rad{0};  ///< Of the rows.
  double noise_m{0.02};                   ///< Standard deviation per ray.
};

/// A receiver of satellite navigation; noises are standard deviations of one satellite's.
struct GnssSensor {
  SimClock::duration period{std::chrono::milliseconds{200}};
  double mask_rad{0.08726646259971647};  ///< Least elevation of a satellite: 5 degrees.
  double drift_m{2.5};                   ///< Of a range's slow error.
  SimClock::duration correlation_time{std::chrono::seconds{100}};  ///< Of that.
  double noise_m{0.5};                                             ///< Of a range's white error.
  double rate_noise_mps{0.05};
};

/// A camera looks ahead, then turned by roll, pitch and yaw as a body's attitude is.
struct CameraDirection {
  double roll_rad{0.0};
  double pitch_rad{0.0};  ///< Positive: down.
  double yaw_rad{0.0};
};
inline constexpr CameraDirection kCameraForward{};
inline constexpr CameraDirection kCameraDown{
    .roll_rad = 0.0, .pitch_rad = 1.5707963267948966, .yaw_rad = 0.0};

/// Defaults are FL-AIR's, offset ours.
struct CameraSensor {
  std::uint32_t width_px{320};
  std::uint32_t height_px{240};
  SimClock::duration period{std::chrono::milliseconds{50}};
  double field_rad{1.2217304763960306};  ///< Horizontal: 70 degrees.
  CameraDirection direction{kCameraForward};
  std::array<double, 3> offset_m{0.0, 0.0, 0.05};  ///< Ahead, to the left, up.
};

/// What a vehicle has besides IMU and motion capture.
struct VehicleSensors {
  std::optional<UltrasonicSensor> ultrasonic;
  std::optional<LidarSensor> lidar;
  std::optional<GnssSensor> gnss;
  std::optional<CameraSensor> camera;
};

/// FL-AIR's quadrotor; defaults are the ones of its simulator_x4.xml.
struct X4Vehicle {
  double mass_kg{1.2};
  double arm_m{0.2};
  double inertia_roll_kgm2{0.006};
  double inertia_pitch_kgm2{0.006};
  double inertia_yaw_kgm2{0.1};
  double drag_vertical_Nspm{0.01};
  double drag_lateral_Nspm{0.4};
  SimClock::duration motor_timeout{std::chrono::milliseconds{100}};
  bool faithful{false};  ///< FL-AIR's own integrator and signs.
  Collision collision;
  VehicleSensors sensors;
};

// Of the same source: thrust = kX4ThrustFactor u^2, torque = kX4TorqueFactor u^2, with the motor's
// speed u = kX4SpeedPerCommand x command.
inline constexpr double kX4ThrustFactor_N = 0.001;
inline constexpr double kX4TorqueFactor_Nm = 0.001;
inline constexpr double kX4SpeedPerCommand = 86.0;

/// A radio node that stays where it starts, without physics.
struct FixedVehicle {};

using Vehicle = std::variant<X4Vehicle, FixedVehicle>;

}  // namespace cuscus::scenario
