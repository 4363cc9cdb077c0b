#include "world/app/configuration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "proto/shm/vehicle_memory.h"

namespace cuscus::world {
namespace {

/// A fleet beyond this is a corrupt message, not a scenario.
constexpr std::uint32_t kMaxNodes = 100'000;
constexpr double kRightAngle_rad = std::numbers::pi / 2.0;

void require(bool holds, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument{"world configuration: " + what};
  }
}

/// How a configuration names what becomes of a vehicle that touches something.
std::optional<CollisionBehaviour> behaviour_of(const std::string& name) {
  if (name == "stop") {
    return CollisionBehaviour::kStop;
  }
  if (name == "bounce") {
    return CollisionBehaviour::kBounce;
  }
  if (name == "crash") {
    return CollisionBehaviour::kCrash;
  }
  return std::nullopt;
}

bool is_amount(double value) { return std::isfinite(value) && value >= 0.0; }

void check_collision(const proto::CollisionConfiguration& collision, const std::string& name) {
  require(behaviour_of(collision.behaviour()).has_value(), name + "collision.behaviour is '" +
                                                               collision.behaviour() +
                                                               "', must be stop, bounce or crash");
  require(is_amount(collision.restitution()) && collision.restitution() <= 1.0,
          name + "collision.restitution must be 0 ... 1");
  require(is_amount(collision.radius_m()), name + "collision.radius_m must be 0 or more");
}

void check_period(const std::string& name, std::int64_t period_ns, std::int64_t step_ns) {
  require(period_ns == 0 || period_ns >= step_ns, name + " must be 0 (none) or at least the step");
}

void check_ultrasonic(const proto::UltrasonicConfiguration& ultrasonic, const std::string& name) {
  require(std::isfinite(ultrasonic.range_m()) && ultrasonic.range_m() > 0.0,
          name + "ultrasonic.range_m must be above 0");
  require(ultrasonic.half_angle_rad() > 0.0 && ultrasonic.half_angle_rad() < kRightAngle_rad,
          name + "ultrasonic.half_angle_rad must be above 0 and below a right angle");
  require(is_amount(ultrasonic.noise_m()), name + "ultrasonic.noise_m must be 0 or more");
  constexpr double kRounding = 1e-9;
  const double length = parameters_of(ultrasonic).axis_B.norm();
  require(std::abs(length - 1.0) < kRounding, name + "ultrasonic.axis_B must be of length 1");
}

void check_lidar(const proto::LidarConfiguration& lidar, const std::string& name) {
  const auto rows = static_cast<std::uint64_t>(lidar.elevations_rad_size());
  require(rows >= 1 && rows <= shm::kMaxLidarRows && lidar.rays() >= 1 &&
              rows * lidar.rays() <= shm::kMaxLidarRays,
          name + "lidar has " + std::to_string(rows) + " rows of " + std::to_string(lidar.rays()) +
              " rays, must have 1 ... " + std::to_string(shm::kMaxLidarRows) + " rows and 1 ... " +
              std::to_string(shm::kMaxLidarRays) + " rays in all");
  require(lidar.field_rad() > 0.0 && lidar.field_rad() <= 4.0 * kRightAngle_rad,
          name + "lidar.field_rad must be above 0 and at most a whole turn");
  for (const double elevation_rad : lidar.elevations_rad()) {
    require(std::abs(elevation_rad) <= kRightAngle_rad,
            name + "lidar.elevations_rad must be within a right angle");
  }
  require(std::isfinite(lidar.range_m()) && lidar.range_m() > 0.0,
          name + "lidar.range_m must be above 0");
  require(is_amount(lidar.noise_m()), name + "lidar.noise_m must be 0 or more");
}

void check_gnss(const proto::GnssConfiguration& gnss, const std::string& name) {
  require(gnss.period_ns() > 0 && gnss.correlation_time_ns() > 0,
          name + "gnss.period_ns and gnss.correlation_time_ns must be above 0");
  require(is_amount(gnss.mask_rad()) && gnss.mask_rad() < kRightAngle_rad,
          name + "gnss.mask_rad must be 0 or more and below a right angle");
  require(
      is_amount(gnss.drift_m()) && is_amount(gnss.noise_m()) && is_amount(gnss.rate_noise_mps()),
      name + "the noise of gnss must be 0 or more");
}

void check_site(const proto::GeodeticPosition& site) {
  constexpr double kQuarter_deg = 90.0;
  require(std::abs(site.latitude_deg()) <= kQuarter_deg && std::isfinite(site.longitude_deg()) &&
              std::isfinite(site.height_m()),
          "site must have a latitude within 90 degrees, and finite numbers");
}

void check_views(const proto::WorldNode& node, std::int64_t step_ns, const std::string& name) {
  if (node.has_ultrasonic()) {
    check_period(name + "ultrasonic.period_ns", node.ultrasonic().period_ns(), step_ns);
    check_ultrasonic(node.ultrasonic(), name);
  }
  if (node.has_lidar()) {
    check_period(name + "lidar.period_ns", node.lidar().period_ns(), step_ns);
    check_lidar(node.lidar(), name);
  }
  if (node.has_gnss()) {
    check_period(name + "gnss.period_ns", node.gnss().period_ns(), step_ns);
    check_gnss(node.gnss(), name);
  }
}

void check_node(const proto::WorldNode& node, std::int64_t step_ns) {
  const std::string name = "node " + std::to_string(node.node()) + " '" + node.name() + "': ";
  require(node.node() < kMaxNodes, name + "the node number must be below 100000");
  const proto::Vector3& start = node.p_wb_start_m();
  require(std::isfinite(start.x()) && std::isfinite(start.y()) && is_amount(start.z()),
          name + "the start position must be finite and not below the ground");
  require(std::isfinite(node.yaw_start_rad()), name + "yaw_start_rad must be finite");
  if (!node.has_multirotor()) {
    return;
  }
  require(node.multirotor().motor_timeout_ns() > 0, name + "motor_timeout_ns must be above 0");
  if (node.has_collision()) {
    check_collision(node.collision(), name);
  }
  check_views(node, step_ns, name);
  try {
    check_parameters(parameters_of(node.multirotor()));
  } catch (const std::invalid_argument& error) {
    require(false, name + error.what());
  }
}

}  // namespace

void check_configuration(const proto::WorldConfiguration& configuration) {
  require(configuration.step_ns() > 0 && configuration.step_ns() <= 1'000'000'000,
          "step_ns must be above 0 and at most one second");
  require(is_amount(configuration.gravity_mps2()), "gravity_mps2 must be 0 or more");
  require(is_amount(configuration.gyro_noise_radps()) &&
              is_amount(configuration.accelerometer_noise_mps2()) &&
              is_amount(configuration.motion_capture_noise_m()) &&
              is_amount(configuration.motion_capture_noise_rad()),
          "the standard deviation of noise must be 0 or more");
  check_period("imu_period_ns", configuration.imu_period_ns(), configuration.step_ns());
  check_period("motion_capture_period_ns", configuration.motion_capture_period_ns(),
               configuration.step_ns());
  check_site(configuration.site());
  std::set<std::uint32_t> numbers;
  for (const proto::WorldNode& node : configuration.nodes()) {
    check_node(node, configuration.step_ns());
    require(numbers.insert(node.node()).second,
            "node " + std::to_string(node.node()) + " is there twice");
  }
}

std::uint32_t slot_count(const proto::WorldConfiguration& configuration) {
  std::uint32_t count = 0;
  for (const proto::WorldNode& node : configuration.nodes()) {
    count = std::max(count, node.node() + 1);
  }
  return count;
}

MultirotorParameters parameters_of(const proto::MultirotorParameters& message) {
  return {.source = message.source(),
          .mass_kg = message.mass_kg(),
          .arm_m = message.arm_m(),
          .thrust_factor = message.thrust_factor(),
          .torque_factor = message.torque_factor(),
          .drag_vertical_Nspm = message.drag_vertical(),
          .drag_lateral_Nspm = message.drag_lateral(),
          .inertia_roll_kgm2 = message.inertia_roll_kgm2(),
          .inertia_pitch_kgm2 = message.inertia_pitch_kgm2(),
          .inertia_yaw_kgm2 = message.inertia_yaw_kgm2(),
          .motor_speed_per_command = message.motor_speed_per_command()};
}

UltrasonicParameters parameters_of(const proto::UltrasonicConfiguration& message) {
  return {.axis_B = {message.axis_b().x(), message.axis_b().y(), message.axis_b().z()},
          .half_angle_rad = message.half_angle_rad(),
          .range_m = message.range_m(),
          .noise_m = message.noise_m()};
}

LidarParameters parameters_of(const proto::LidarConfiguration& message) {
  return {.rays = message.rays(),
          .field_rad = message.field_rad(),
          .elevations_rad = {message.elevations_rad().begin(), message.elevations_rad().end()},
          .range_m = message.range_m(),
          .noise_m = message.noise_m()};
}

GnssParameters parameters_of(const proto::GnssConfiguration& message) {
  return {.period = SimClock::duration{message.period_ns()},
          .mask_rad = message.mask_rad(),
          .drift_m = message.drift_m(),
          .correlation_time = SimClock::duration{message.correlation_time_ns()},
          .noise_m = message.noise_m(),
          .rate_noise_mps = message.rate_noise_mps()};
}

city::Geodetic site_of(const proto::WorldConfiguration& configuration) {
  return {.latitude_deg = configuration.site().latitude_deg(),
          .longitude_deg = configuration.site().longitude_deg(),
          .height_m = configuration.site().height_m()};
}

CollisionBody collision_body_of(const proto::WorldNode& node) {
  CollisionBody body{.mass_kg = node.multirotor().mass_kg()};
  if (node.has_collision()) {
    body.radius_m = node.collision().radius_m();
    body.behaviour = behaviour_of(node.collision().behaviour()).value_or(CollisionBehaviour::kStop);
    body.restitution = node.collision().restitution();
  }
  body.loses_all_speed =
      node.multirotor().faithful() && body.behaviour == CollisionBehaviour::kStop;
  return body;
}

}  // namespace cuscus::world
