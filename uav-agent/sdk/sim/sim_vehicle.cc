#include "uav-agent/sdk/sim/sim_vehicle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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
      radio_mapping_{std::move(memories.radio)},
      camera_mapping_{std::move(memories.camera)},
      sensor_reader_{sensor_mapping_.bytes()},
      actuator_writer_{actuator_mapping_.writable_bytes()} {
  if (fleet_mapping_) {
    fleet_reader_.emplace(fleet_mapping_->bytes());
  }
  if (radio_mapping_) {
    radio_reader_.emplace(radio_mapping_->bytes());
  }
  if (camera_mapping_) {
    camera_reader_.emplace(camera_mapping_->bytes());
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

std::optional<UltrasonicReading> SimVehicle::ultrasonic() const {
  const auto reading = sensor_reader_.ultrasonic();
  if (!reading) {
    return std::nullopt;
  }
  UltrasonicReading converted{.time = sim_time(reading->sim_time_ns),
                              .sequence = reading->sequence,
                              .distance_m = std::nullopt};
  if (std::isfinite(reading->distance_m)) {
    converted.distance_m = reading->distance_m;
  }
  return converted;
}

std::optional<LidarScan> SimVehicle::lidar() const {
  const auto scan = sensor_reader_.lidar();
  if (!scan) {
    return std::nullopt;
  }
  const auto ranges = static_cast<std::ptrdiff_t>(scan->rows) * scan->rays;
  return LidarScan{
      .time = sim_time(scan->sim_time_ns),
      .sequence = scan->sequence,
      .rays = scan->rays,
      .first_azimuth_rad = scan->first_azimuth_rad,
      .azimuth_step_rad = scan->azimuth_step_rad,
      .elevations_rad = {scan->elevation_rad.begin(), scan->elevation_rad.begin() + scan->rows},
      .ranges_m = {scan->range_m.begin(), scan->range_m.begin() + ranges}};
}

std::optional<GnssReading> SimVehicle::gnss() const {
  const auto reading = sensor_reader_.gnss();
  if (!reading) {
    return std::nullopt;
  }
  GnssReading converted{.time = sim_time(reading->sim_time_ns),
                        .sequence = reading->sequence,
                        .satellites_in_view = reading->satellites_in_view,
                        .satellites_received = reading->satellites_received,
                        .fix = std::nullopt};
  if (reading->has_fix != 0) {
    const auto& p = reading->p_WB_m;
    const auto& v = reading->v_WB_W_mps;
    converted.fix = GnssFix{.p_WB_m = {p[0], p[1], p[2]},
                            .v_WB_W_mps = {v[0], v[1], v[2]},
                            .latitude_deg = reading->latitude_deg,
                            .longitude_deg = reading->longitude_deg,
                            .height_m = reading->height_m,
                            .hdop = reading->hdop,
                            .vdop = reading->vdop};
  }
  return converted;
}

std::optional<CameraPicture> SimVehicle::camera() const {
  if (!camera_reader_) {
    return std::nullopt;
  }
  const shm::PictureShape& shape = camera_reader_->shape();
  CameraPicture picture{.time = {},
                        .width_px = shape.width_px,
                        .height_px = shape.height_px,
                        .focal_px = shape.focal_px,
                        .rgb = std::vector<std::byte>(shape.byte_size())};
  const auto frame = camera_reader_->read(picture.rgb);
  if (!frame) {
    return std::nullopt;
  }
  picture.time = sim_time(frame->sim_time_ns);
  picture.sequence = frame->sequence;
  return picture;
}

std::uint64_t SimVehicle::camera_pictures() const {
  return camera_reader_ ? camera_reader_->published() : 0;
}

std::optional<MotionCaptureReading> SimVehicle::motion_capture_of(std::uint32_t node) const {
  if (node >= fleet_reader_->node_count()) {
    return std::nullopt;
  }
  const auto reading = fleet_reader_->reading(node);
  return reading ? std::optional{converted(*reading)} : std::nullopt;
}

std::vector<Neighbour> SimVehicle::neighbours() const {
  std::vector<Neighbour> neighbours;
  const std::uint32_t nodes = radio_reader_ ? radio_reader_->node_count() : 0;
  for (std::uint32_t node = 0; node < nodes; ++node) {
    if (const auto reading = radio_reader_->neighbour(node)) {
      const SimTime heard = sim_time(reading->sim_time_ns);
      neighbours.push_back({.node = node,
                            .heard = heard,
                            .age = std::max(clock_.now() - heard, SimClock::duration{0}),
                            .frames = reading->frames,
                            .received = {reading->received_dbm},
                            .mean = {reading->mean_dbm},
                            .snr = {reading->snr_db},
                            .rate_kbps = reading->rate_kbps});
    }
  }
  return neighbours;
}

std::optional<Decibel> SimVehicle::link_budget(std::uint32_t node) const {
  if (!radio_reader_ || node >= radio_reader_->node_count()) {
    return std::nullopt;
  }
  const auto reading = radio_reader_->neighbour(node);
  if (!reading) {
    return std::nullopt;
  }
  return DecibelMilliwatt{reading->received_dbm} - DecibelMilliwatt{radio_reader_->threshold_dbm()};
}

void SimVehicle::set_motors(const MotorCommands& commands, SimTime now) {
  shm::ActuatorCommand command{};
  command.sim_time_ns = to_ns(now);
  command.sequence = ++command_sequence_;
  std::copy(commands.begin(), commands.end(), command.motors.begin());
  actuator_writer_.publish(command);
}

}  // namespace cuscus::sdk
