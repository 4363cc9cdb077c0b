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

/// Sensors of one vehicle: the world writes, the vehicle's agent reads.
struct SensorMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSSENSE");
  static constexpr std::uint32_t kVersion = 1;

  Header header;
  alignas(kCacheLine) Seqlock<MotionCaptureReading> motion_capture;
  alignas(kCacheLine) Seqlock<ImuReading> imu;
};

class SensorMemoryWriter {
 public:
  [[nodiscard]] static constexpr std::size_t byte_size() { return sizeof(SensorMemoryLayout); }
  explicit SensorMemoryWriter(std::span<std::byte> memory);

  void publish(const MotionCaptureReading& reading) noexcept;
  void publish(const ImuReading& reading) noexcept;

 private:
  SensorMemoryLayout* layout_;
};

class SensorMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not sensor memory.
  explicit SensorMemoryReader(std::span<const std::byte> memory);

  /// Nothing before the first reading.
  [[nodiscard]] std::optional<MotionCaptureReading> motion_capture() const noexcept;
  [[nodiscard]] std::optional<ImuReading> imu() const noexcept;

 private:
  const SensorMemoryLayout* layout_;
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
