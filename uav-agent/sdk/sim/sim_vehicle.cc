#include "uav-agent/sdk/sim/sim_vehicle.h"

#include <algorithm>
#include <utility>

#include "common/posix/monotonic_clock.h"

namespace cuscus::sdk {
namespace {

MotionCaptureReading converted(const shm::MotionCaptureReading& reading) {
  return {.time = sim_time(reading.sim_time_ns),
          .sequence = reading.sequence,
          .p_WB_m = {reading.p_WB_m[0], reading.p_WB_m[1], reading.p_WB_m[2]},
          .q_WB = {reading.q_WB[0], reading.q_WB[1], reading.q_WB[2], reading.q_WB[3]}};
}

}  // namespace

SimulatedClock::SimulatedClock(posix::MemoryMapping page)
    : mapping_{std::move(page)}, page_{mapping_.bytes()} {}

SimTime SimulatedClock::now() const {
  const auto start_ns = page_.start_monotonic_ns();
  return start_ns ? sim_time(posix::monotonic_now_ns() - *start_ns) : SimTime{};
}

void SimulatedClock::sleep_until(SimTime instant) const {
  if (const auto start_ns = page_.start_monotonic_ns()) {
    posix::sleep_until_monotonic(*start_ns + to_ns(instant));
  }
}

SimVehicle::SimVehicle(Memories memories)
    : clock_{std::move(memories.clock_page)},
      sensor_mapping_{std::move(memories.sensors)},
      actuator_mapping_{std::move(memories.actuators)},
      fleet_mapping_{std::move(memories.fleet)},
      sensor_reader_{sensor_mapping_.bytes()},
      actuator_writer_{actuator_mapping_.writable_bytes()} {
  if (fleet_mapping_) {
    fleet_reader_.emplace(fleet_mapping_->bytes());
  }
}

std::optional<ImuReading> SimVehicle::imu() const {
  const auto reading = sensor_reader_.imu();
  if (!reading) {
    return std::nullopt;
  }
  const auto& rate = reading->angular_rate_B_radps;
  const auto& force = reading->specific_force_B_mps2;
  return ImuReading{.time = sim_time(reading->sim_time_ns),
                    .sequence = reading->sequence,
                    .angular_rate_B_radps = {rate[0], rate[1], rate[2]},
                    .specific_force_B_mps2 = {force[0], force[1], force[2]}};
}

std::optional<MotionCaptureReading> SimVehicle::motion_capture() const {
  const auto reading = sensor_reader_.motion_capture();
  return reading ? std::optional{converted(*reading)} : std::nullopt;
}

std::optional<MotionCaptureReading> SimVehicle::motion_capture_of(std::uint32_t node) const {
  if (node >= fleet_reader_->node_count()) {
    return std::nullopt;
  }
  const auto reading = fleet_reader_->reading(node);
  return reading ? std::optional{converted(*reading)} : std::nullopt;
}

void SimVehicle::set_motors(const MotorCommands& commands, SimTime now) {
  shm::ActuatorCommand command{};
  command.sim_time_ns = to_ns(now);
  command.sequence = ++command_sequence_;
  std::copy(commands.begin(), commands.end(), command.motors.begin());
  actuator_writer_.publish(command);
}

}  // namespace cuscus::sdk
