#include "world/app/view_sensors.h"

#include <algorithm>
#include <limits>
#include <span>

#include "world/app/configuration.h"

namespace cuscus::world {
namespace {

shm::LidarScan empty_scan(const LidarParameters& parameters) {
  shm::LidarScan scan{};
  scan.rows = static_cast<std::uint32_t>(parameters.elevations_rad.size());
  scan.rays = parameters.rays;
  scan.first_azimuth_rad = lidar_azimuth_rad(parameters, 0);
  scan.azimuth_step_rad =
      parameters.rays > 1 ? lidar_azimuth_rad(parameters, 1) - scan.first_azimuth_rad : 0.0;
  std::transform(parameters.elevations_rad.begin(), parameters.elevations_rad.end(),
                 scan.elevation_rad.begin(),
                 [](double elevation_rad) { return static_cast<float>(elevation_rad); });
  return scan;
}

}  // namespace

ViewSensors::ViewSensors(std::uint64_t seed, const proto::WorldNode& node, const Place& place,
                         shm::SensorMemoryWriter& memory)
    : surroundings_{place.surroundings}, memory_{&memory} {
  if (node.has_ultrasonic()) {
    ultrasonic_ = {.sensor = {seed, node.node(), parameters_of(node.ultrasonic())},
                   .schedule = {.period_ns = node.ultrasonic().period_ns()}};
  }
  if (node.has_lidar()) {
    const LidarParameters parameters = parameters_of(node.lidar());
    lidar_ =
        std::make_unique<TimedLidar>(TimedLidar{.sensor = {seed, node.node(), parameters},
                                                .schedule = {.period_ns = node.lidar().period_ns()},
                                                .scan = empty_scan(parameters)});
  }
  if (node.has_gnss()) {
    gnss_.emplace(TimedGnss{.sensor = {seed, node.node(), parameters_of(node.gnss()),
                                       Constellation{place.origin, place.epoch}},
                            .schedule = {.period_ns = node.gnss().period_ns()},
                            .frame = city::LocalFrame{place.origin}});
  }
}

void ViewSensors::publish(const RigidBodyState& body, SimTime now) {
  if (ultrasonic_) {
    if (const auto reading = ultrasonic_->schedule.due(to_ns(now))) {
      const auto distance_m = ultrasonic_->sensor.sample(surroundings_, body, *reading);
      memory_->publish(shm::UltrasonicReading{
          .sim_time_ns = to_ns(now),
          .sequence = *reading + 1,
          .distance_m = distance_m.value_or(std::numeric_limits<double>::infinity())});
    }
  }
  if (lidar_ != nullptr) {
    if (const auto reading = lidar_->schedule.due(to_ns(now))) {
      lidar_->scan.sim_time_ns = to_ns(now);
      lidar_->scan.sequence = *reading + 1;
      lidar_->sensor.sample(surroundings_, body, *reading,
                            std::span{lidar_->scan.range_m}.first(lidar_->sensor.size()));
      memory_->publish(lidar_->scan);
    }
  }
  if (gnss_) {
    if (const auto reading = gnss_->schedule.due(to_ns(now))) {
      publish_gnss(body, now, *reading);
    }
  }
}

void ViewSensors::publish_gnss(const RigidBodyState& body, SimTime now, std::uint64_t reading) {
  const GnssSample sample = gnss_->sensor.sample(surroundings_, body, now, reading);
  shm::GnssReading message{};
  message.sim_time_ns = to_ns(now);
  message.sequence = reading + 1;
  message.satellites_in_view = sample.in_view;
  message.satellites_received = sample.received;
  if (sample.fix) {
    const Eigen::Vector3d& p = sample.fix->p_WB_m;
    const Eigen::Vector3d& v = sample.fix->v_WB_W_mps;
    const city::Geodetic geodetic = gnss_->frame.to_geodetic(p);
    message.has_fix = 1;
    message.p_WB_m = {p.x(), p.y(), p.z()};
    message.v_WB_W_mps = {v.x(), v.y(), v.z()};
    message.latitude_deg = geodetic.latitude_deg;
    message.longitude_deg = geodetic.longitude_deg;
    message.height_m = geodetic.height_m;
    message.hdop = sample.fix->hdop;
    message.vdop = sample.fix->vdop;
  }
  memory_->publish(message);
}

}  // namespace cuscus::world
