#include "orchestrator/plan/world_configuration.h"

#include <string>
#include <variant>

#include "common/scenario/names.h"

namespace cuscus::orchestrator {
namespace {

proto::CollisionConfiguration collision_of(const scenario::Collision& from) {
  proto::CollisionConfiguration collision;
  collision.set_behaviour(scenario::name_of(scenario::kCollisionBehaviourNames, from.behaviour));
  collision.set_restitution(from.restitution);
  collision.set_radius_m(from.radius_m);
  return collision;
}

proto::Vector3 axis_of(scenario::SensorDirection direction) {
  switch (direction) {
    case scenario::SensorDirection::kDown:
      return vector_of({0.0, 0.0, -1.0});
    case scenario::SensorDirection::kUp:
      return vector_of({0.0, 0.0, 1.0});
    case scenario::SensorDirection::kForward:
      return vector_of({1.0, 0.0, 0.0});
    case scenario::SensorDirection::kBackward:
      return vector_of({-1.0, 0.0, 0.0});
    case scenario::SensorDirection::kLeft:
      return vector_of({0.0, 1.0, 0.0});
    case scenario::SensorDirection::kRight:
      return vector_of({0.0, -1.0, 0.0});
  }
  return {};
}

void add_sensors(const scenario::VehicleSensors& from, proto::WorldNode& node) {
  if (from.ultrasonic) {
    proto::UltrasonicConfiguration& ultrasonic = *node.mutable_ultrasonic();
    ultrasonic.set_period_ns(from.ultrasonic->period.count());
    ultrasonic.set_range_m(from.ultrasonic->range_m);
    ultrasonic.set_half_angle_rad(from.ultrasonic->beam_rad / 2.0);
    ultrasonic.set_noise_m(from.ultrasonic->noise_m);
    *ultrasonic.mutable_axis_b() = axis_of(from.ultrasonic->direction);
  }
  if (from.lidar) {
    proto::LidarConfiguration& lidar = *node.mutable_lidar();
    lidar.set_period_ns(from.lidar->period.count());
    lidar.set_rays(from.lidar->rays);
    lidar.set_field_rad(from.lidar->field_rad);
    for (const double elevation_rad : from.lidar->elevations_rad) {
      lidar.add_elevations_rad(elevation_rad);
    }
    lidar.set_range_m(from.lidar->range_m);
    lidar.set_noise_m(from.lidar->noise_m);
  }
  if (from.gnss) {
    proto::GnssConfiguration& gnss = *node.mutable_gnss();
    gnss.set_period_ns(from.gnss->period.count());
    gnss.set_mask_rad(from.gnss->mask_rad);
    gnss.set_drift_m(from.gnss->drift_m);
    gnss.set_correlation_time_ns(from.gnss->correlation_time.count());
    gnss.set_noise_m(from.gnss->noise_m);
    gnss.set_rate_noise_mps(from.gnss->rate_noise_mps);
  }
}

void set_physics(const scenario::World& from, proto::WorldConfiguration& world) {
  world.set_step_ns(from.step.count());
  world.set_gravity_mps2(from.gravity_mps2);
  world.set_imu_period_ns(from.imu_period.count());
  world.set_gyro_noise_radps(from.gyro_noise_radps);
  world.set_accelerometer_noise_mps2(from.accelerometer_noise_mps2);
  world.set_motion_capture_period_ns(from.motion_capture_period.count());
  world.set_motion_capture_noise_m(from.motion_capture_noise_m);
  world.set_motion_capture_noise_rad(from.motion_capture_noise_rad);
  const city::Geodetic site = from.site.value_or(scenario::kDefaultSite);
  world.mutable_site()->set_latitude_deg(site.latitude_deg);
  world.mutable_site()->set_longitude_deg(site.longitude_deg);
  world.mutable_site()->set_height_m(site.height_m);
  world.set_epoch_unix_s(from.epoch.time_since_epoch().count());
}

proto::WorldNode& add_node(const NodePlan& from, proto::WorldConfiguration& world) {
  proto::WorldNode& node = *world.add_nodes();
  node.set_node(from.index);
  node.set_name(from.name);
  *node.mutable_p_wb_start_m() = vector_of(from.p_WB_start_m);
  return node;
}

}  // namespace

proto::WorldConfiguration world_configuration(const scenario::Scenario& scenario,
                                              std::span<const NodePlan> nodes) {
  proto::WorldConfiguration world;
  world.set_seed(scenario.seed);
  set_physics(scenario.world, world);
  std::size_t next = 0;
  for (const scenario::Group& group : scenario.fleet) {
    const auto* x4 = std::get_if<scenario::X4Vehicle>(&group.vehicle);
    for (std::uint32_t member = 0; member < group.count; ++member) {
      proto::WorldNode& node = add_node(nodes[next++], world);
      node.set_yaw_start_rad(group.start.heading_rad);
      if (x4 != nullptr) {
        *node.mutable_multirotor() = parameters_of(*x4);
        *node.mutable_collision() = collision_of(x4->collision);
        add_sensors(x4->sensors, node);
      }
    }
  }
  if (next < nodes.size()) {
    add_node(nodes[next], world);
  }
  return world;
}

proto::MultirotorParameters parameters_of(const scenario::X4Vehicle& x4) {
  proto::MultirotorParameters parameters;
  const scenario::X4Vehicle original;
  const bool changed = x4.mass_kg != original.mass_kg || x4.arm_m != original.arm_m ||
                       x4.inertia_roll_kgm2 != original.inertia_roll_kgm2 ||
                       x4.inertia_pitch_kgm2 != original.inertia_pitch_kgm2 ||
                       x4.inertia_yaw_kgm2 != original.inertia_yaw_kgm2 ||
                       x4.drag_vertical_Nspm != original.drag_vertical_Nspm ||
                       x4.drag_lateral_Nspm != original.drag_lateral_Nspm ||
                       x4.motor_timeout != original.motor_timeout;
  parameters.set_source(std::string{"FL-AIR, simulator_x4.xml"} +
                        (changed ? ", with changes from the scenario" : ""));
  parameters.set_mass_kg(x4.mass_kg);
  parameters.set_arm_m(x4.arm_m);
  parameters.set_thrust_factor(scenario::kX4ThrustFactor_N);
  parameters.set_torque_factor(scenario::kX4TorqueFactor_Nm);
  parameters.set_drag_vertical(x4.drag_vertical_Nspm);
  parameters.set_drag_lateral(x4.drag_lateral_Nspm);
  parameters.set_inertia_roll_kgm2(x4.inertia_roll_kgm2);
  parameters.set_inertia_pitch_kgm2(x4.inertia_pitch_kgm2);
  parameters.set_inertia_yaw_kgm2(x4.inertia_yaw_kgm2);
  parameters.set_motor_speed_per_command(scenario::kX4SpeedPerCommand);
  parameters.set_motor_timeout_ns(x4.motor_timeout.count());
  parameters.set_faithful(x4.faithful);
  return parameters;
}

proto::Vector3 vector_of(const scenario::Position_m& p_m) {
  proto::Vector3 vector;
  vector.set_x(p_m[0]);
  vector.set_y(p_m[1]);
  vector.set_z(p_m[2]);
  return vector;
}

}  // namespace cuscus::orchestrator
