#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/seqlock.h"

namespace cuscus::shm {

/// What the motion-capture system says of one body. World frame W: ENU; body frame B: FLU.
struct MotionCaptureReading {
  std::int64_t sim_time_ns;
  std::uint64_t sequence;  ///< From 1; 0 means none yet.
  std::array<double, 3> p_WB_m;
  std::array<double, 4> q_WB;  ///< w, x, y, z; unit.
};

/// What the inertial measurement unit says.
struct ImuReading {
  std::int64_t sim_time_ns;
  std::uint64_t sequence;                       ///< From 1; 0 means none yet.
  std::array<double, 3> angular_rate_B_radps;   ///< Gyroscope.
  std::array<double, 3> specific_force_B_mps2;  ///< Accelerometer: +g upwards at rest.
};

/// What the ultrasonic sensor says.
struct UltrasonicReading {
  std::int64_t sim_time_ns;
  std::uint64_t sequence;  ///< From 1; 0 means none yet.
  double distance_m;       ///< Infinite: nothing in range.
};

/// Rays that a scan of a lidar may have, and rows of equal elevation.
inline constexpr std::uint32_t kMaxLidarRays = 4096;
inline constexpr std::uint32_t kMaxLidarRows = 128;

/// One scan of the lidar: `rows` of `rays` each.
struct LidarScan {
  std::int64_t sim_time_ns;
  std::uint64_t sequence;  ///< From 1; 0 means none yet.
  std::uint32_t rows;
  std::uint32_t rays;        ///< Of one row; rows x rays <= kMaxLidarRays.
  double first_azimuth_rad;  ///< In the body, from ahead counter-clockwise.
  double azimuth_step_rad;
  std::array<float, kMaxLidarRows> elevation_rad;  ///< Of each row, above the body's x-y plane.
  std::array<float, kMaxLidarRays> range_m;        ///< Row by row; infinite: nothing in range.
};

/// What the receiver of satellite navigation says.
struct GnssReading {
  std::int64_t sim_time_ns;
  std::uint64_t sequence;            ///< From 1; 0 means none yet.
  std::uint32_t satellites_in_view;  ///< Above the receiver's mask.
  std::uint32_t satellites_received;
  std::uint64_t has_fix;  ///< 0 or 1; without a fix all that follows is 0.
  std::array<double, 3> p_WB_m;
  std::array<double, 3> v_WB_W_mps;
  double latitude_deg;  ///< WGS-84.
  double longitude_deg;
  double height_m;  ///< Above the ellipsoid.
  double hdop;
  double vdop;
};

/// Sensors of one vehicle: the world writes, the vehicle's agent reads. Of a vehicle with a lidar,
/// LidarMemoryLayout follows.
struct SensorMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSSENSE");
  static constexpr std::uint32_t kVersion = 3;

  Header header;
  alignas(kCacheLine) Seqlock<MotionCaptureReading> motion_capture;
  alignas(kCacheLine) Seqlock<ImuReading> imu;
  alignas(kCacheLine) Seqlock<UltrasonicReading> ultrasonic;
  alignas(kCacheLine) Seqlock<GnssReading> gnss;
};

struct LidarMemoryLayout {
  alignas(kCacheLine) Seqlock<LidarScan> scan;
};

class SensorMemoryWriter {
 public:
  [[nodiscard]] static constexpr std::size_t byte_size(bool with_lidar = false) {
    return sizeof(SensorMemoryLayout) + (with_lidar ? sizeof(LidarMemoryLayout) : 0);
  }
  /// `memory` has byte_size() with or without a lidar, and so has the vehicle.
  explicit SensorMemoryWriter(std::span<std::byte> memory);

  void publish(const MotionCaptureReading& reading) noexcept;
  void publish(const ImuReading& reading) noexcept;
  void publish(const UltrasonicReading& reading) noexcept;
  void publish(const GnssReading& reading) noexcept;
  /// Of a vehicle with a lidar.
  void publish(const LidarScan& scan) noexcept;

 private:
  SensorMemoryLayout* layout_;
  LidarMemoryLayout* lidar_{nullptr};
};

class SensorMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not sensor memory.
  explicit SensorMemoryReader(std::span<const std::byte> memory);

  /// Nothing before the first reading.
  [[nodiscard]] std::optional<MotionCaptureReading> motion_capture() const noexcept;
  [[nodiscard]] std::optional<ImuReading> imu() const noexcept;
  [[nodiscard]] std::optional<UltrasonicReading> ultrasonic() const noexcept;
  [[nodiscard]] std::optional<GnssReading> gnss() const noexcept;
  /// Nothing of a vehicle without one, either.
  [[nodiscard]] std::optional<LidarScan> lidar() const noexcept;

 private:
  const SensorMemoryLayout* layout_;
  const LidarMemoryLayout* lidar_{nullptr};
};

/// What the agent asks of its motors.
struct ActuatorCommand {
  std::int64_t sim_time_ns;  ///< When it was computed.
  std::uint64_t sequence;    ///< From 1; a repeated number is no new command.
  /// Per motor, 0 ... 1. X4: front left, front right, rear left, rear right. Unused ones are 0.
  std::array<double, 8> motors;
};

/// Actuators of one vehicle: its agent writes, the world reads and trusts nothing.
struct ActuatorMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSMOTOR");
  static constexpr std::uint32_t kVersion = 1;

  Header header;
  alignas(kCacheLine) Seqlock<ActuatorCommand> command;
};

/// The orchestrator lays the memory out; the agent then attaches and writes.
class ActuatorMemoryWriter {
 public:
  [[nodiscard]] static constexpr std::size_t byte_size() { return sizeof(ActuatorMemoryLayout); }
  static void lay_out(std::span<std::byte> memory);

  /// @throws LayoutError when `memory` is not actuator memory.
  explicit ActuatorMemoryWriter(std::span<std::byte> memory);

  void publish(const ActuatorCommand& command) noexcept;

 private:
  ActuatorMemoryLayout* layout_;
};

class ActuatorMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not actuator memory.
  explicit ActuatorMemoryReader(std::span<const std::byte> memory);

  /// As the agent wrote it, unchecked; nothing when it is never readable as a whole.
  [[nodiscard]] std::optional<ActuatorCommand> command() const noexcept;

  /// Changes with every command that is published; cheap to ask at every step.
  [[nodiscard]] std::uint64_t version() const noexcept;

 private:
  const ActuatorMemoryLayout* layout_;
};

}  // namespace cuscus::shm
