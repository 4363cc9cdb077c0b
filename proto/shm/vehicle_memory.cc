#include "proto/shm/vehicle_memory.h"

#include <cassert>
#include <new>

namespace cuscus::shm {

SensorMemoryWriter::SensorMemoryWriter(std::span<std::byte> memory)
    : layout_{new (memory.data()) SensorMemoryLayout{}} {
  if (memory.size() == byte_size(true)) {
    lidar_ = new (memory.data() + sizeof(SensorMemoryLayout)) LidarMemoryLayout{};
  }
  write_header(memory, {.magic = SensorMemoryLayout::kMagic,
                        .version = SensorMemoryLayout::kVersion,
                        .node_count = 0,
                        .byte_size = byte_size(lidar_ != nullptr)});
}

void SensorMemoryWriter::publish(const UltrasonicReading& reading) noexcept {
  layout_->ultrasonic.store(reading);
}

void SensorMemoryWriter::publish(const GnssReading& reading) noexcept {
  layout_->gnss.store(reading);
}

void SensorMemoryWriter::publish(const LidarScan& scan) noexcept {
  assert(lidar_ != nullptr);
  lidar_->scan.store(scan);
}

void SensorMemoryWriter::publish(const MotionCaptureReading& reading) noexcept {
  layout_->motion_capture.store(reading);
}

void SensorMemoryWriter::publish(const ImuReading& reading) noexcept {
  layout_->imu.store(reading);
}

SensorMemoryReader::SensorMemoryReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const SensorMemoryLayout*>(memory.data())} {
  checked_header(memory, SensorMemoryLayout::kMagic, SensorMemoryLayout::kVersion);
  if (memory.size() == SensorMemoryWriter::byte_size(true)) {
    lidar_ = reinterpret_cast<const LidarMemoryLayout*>(memory.data() + sizeof(SensorMemoryLayout));
  }
}

std::optional<UltrasonicReading> SensorMemoryReader::ultrasonic() const noexcept {
  const auto reading = layout_->ultrasonic.load();
  return reading && reading->sequence != 0 ? reading : std::nullopt;
}

std::optional<GnssReading> SensorMemoryReader::gnss() const noexcept {
  const auto reading = layout_->gnss.load();
  return reading && reading->sequence != 0 ? reading : std::nullopt;
}

std::optional<LidarScan> SensorMemoryReader::lidar() const noexcept {
  if (lidar_ == nullptr) {
    return std::nullopt;
  }
  const auto scan = lidar_->scan.load();
  const bool whole = scan && scan->sequence != 0 && scan->rows <= kMaxLidarRows &&
                     std::uint64_t{scan->rows} * scan->rays <= kMaxLidarRays;
  return whole ? scan : std::nullopt;
}

std::optional<MotionCaptureReading> SensorMemoryReader::motion_capture() const noexcept {
  const auto reading = layout_->motion_capture.load();
  return reading && reading->sequence != 0 ? reading : std::nullopt;
}

std::optional<ImuReading> SensorMemoryReader::imu() const noexcept {
  const auto reading = layout_->imu.load();
  return reading && reading->sequence != 0 ? reading : std::nullopt;
}

void ActuatorMemoryWriter::lay_out(std::span<std::byte> memory) {
  new (memory.data()) ActuatorMemoryLayout{};
  write_header(memory, {.magic = ActuatorMemoryLayout::kMagic,
                        .version = ActuatorMemoryLayout::kVersion,
                        .node_count = 0,
                        .byte_size = byte_size()});
}

ActuatorMemoryWriter::ActuatorMemoryWriter(std::span<std::byte> memory)
    : layout_{reinterpret_cast<ActuatorMemoryLayout*>(memory.data())} {
  checked_header(memory, ActuatorMemoryLayout::kMagic, ActuatorMemoryLayout::kVersion);
}

void ActuatorMemoryWriter::publish(const ActuatorCommand& command) noexcept {
  layout_->command.store(command);
}

ActuatorMemoryReader::ActuatorMemoryReader(std::span<const std::byte> memory)
    : layout_{reinterpret_cast<const ActuatorMemoryLayout*>(memory.data())} {
  checked_header(memory, ActuatorMemoryLayout::kMagic, ActuatorMemoryLayout::kVersion);
}

std::optional<ActuatorCommand> ActuatorMemoryReader::command() const noexcept {
  return layout_->command.load();
}

std::uint64_t ActuatorMemoryReader::version() const noexcept { return layout_->command.version(); }

}  // namespace cuscus::shm
