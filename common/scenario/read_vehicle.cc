#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

/// From the end of an arm to the tips of a rotor of 8 inches, the size that goes with such arms.
constexpr double kRotorRadius_m = 0.1;
/// Of a camera, along each axis.
constexpr double kMostOffset_m = 2.0;

Collision read_collision(const json* value, const std::string& path, double arm_m,
                         Problems& problems) {
  Collision collision;
  ObjectReader reader{value, path, problems};
  collision.behaviour = reader.choice("behaviour", collision.behaviour, kCollisionBehaviourNames);
  collision.restitution = reader.number("restitution", collision.restitution, {0.0, 1.0});
  collision.radius_m = reader.quantity("radius", arm_m + kRotorRadius_m, {kLength, "1 cm", "20 m"});
  reader.finish();
  return collision;
}

/// The angles under `key`, one or more.
std::vector<double> read_elevations(ObjectReader& reader, const std::string& key,
                                    std::vector<double> fallback_rad) {
  const json* value = reader.child(key);
  if (value == nullptr) {
    return fallback_rad;
  }
  if (!value->is_array() || value->empty() || value->size() > kMaxLidarRows) {
    reader.problem(key, (value->is_array() ? "has " + std::to_string(value->size()) + " elements"
                                           : shown(*value) + " is not an array") +
                            "; allowed: 1 ... " + std::to_string(kMaxLidarRows) +
                            " angles, such as [\"-15 deg\", \"0 deg\"]");
    return fallback_rad;
  }
  std::vector<double> elevations_rad;
  for (std::size_t i = 0; i < value->size(); ++i) {
    elevations_rad.push_back(read_quantity(value->at(i),
                                           reader.path_of(key) + '/' + std::to_string(i), 0.0,
                                           {kAngle, "-90 deg", "90 deg"}, reader.problems()));
  }
  return elevations_rad;
}

std::optional<UltrasonicSensor> read_ultrasonic(const json* value, const std::string& path,
                                                Problems& problems) {
  if (value == nullptr ||
      is_none(value, path, "rate, range, beam, noise and direction", problems)) {
    return std::nullopt;
  }
  UltrasonicSensor sensor;
  ObjectReader reader{value, path, problems};
  sensor.period = reader.period_of_rate("rate", sensor.period, "1 Hz", "100 Hz");
  sensor.range_m = reader.quantity("range", sensor.range_m, {kLength, "10 cm", "100 m"});
  sensor.beam_rad = reader.quantity("beam", sensor.beam_rad, {kAngle, "1 deg", "170 deg"});
  sensor.noise_m = reader.quantity("noise", sensor.noise_m, {kLength, "0 m", "1 m"});
  sensor.direction = reader.choice("direction", sensor.direction, kSensorDirectionNames);
  reader.finish();
  return sensor;
}

std::optional<LidarSensor> read_lidar(const json* value, const std::string& path,
                                      Problems& problems) {
  if (value == nullptr ||
      is_none(value, path, "rate, range, field, rays, elevations and noise", problems)) {
    return std::nullopt;
  }
  LidarSensor lidar;
  ObjectReader reader{value, path, problems};
  lidar.period = reader.period_of_rate("rate", lidar.period, "1 Hz", "100 Hz");
  lidar.range_m = reader.quantity("range", lidar.range_m, {kLength, "1 m", "1 km"});
  lidar.field_rad = reader.quantity("field", lidar.field_rad, {kAngle, "1 deg", "360 deg"});
  lidar.rays = reader.integer<std::uint32_t>("rays", lidar.rays, {1, kMaxLidarRays});
  lidar.elevations_rad = read_elevations(reader, "elevations", lidar.elevations_rad);
  lidar.noise_m = reader.quantity("noise", lidar.noise_m, {kLength, "0 m", "1 m"});
  if (lidar.rays * lidar.elevations_rad.size() > kMaxLidarRays) {
    reader.problem("rays", std::to_string(lidar.rays) + " in each of " +
                               std::to_string(lidar.elevations_rad.size()) +
                               " rows are too many; allowed: " + std::to_string(kMaxLidarRays) +
                               " in all");
  }
  reader.finish();
  return lidar;
}

std::optional<GnssSensor> read_gnss(const json* value, const std::string& path,
                                    Problems& problems) {
  if (value == nullptr ||
      is_none(value, path, "rate, mask, drift, correlation_time, noise and rate_noise", problems)) {
    return std::nullopt;
  }
  GnssSensor gnss;
  ObjectReader reader{value, path, problems};
  gnss.period = reader.period_of_rate("rate", gnss.period, "1 Hz", "50 Hz");
  gnss.mask_rad = reader.quantity("mask", gnss.mask_rad, {kAngle, "0 deg", "60 deg"});
  gnss.drift_m = reader.quantity("drift", gnss.drift_m, {kLength, "0 m", "1 km"});
  gnss.correlation_time = reader.duration("correlation_time", gnss.correlation_time, "1 s", "24 h");
  gnss.noise_m = reader.quantity("noise", gnss.noise_m, {kLength, "0 m", "1 km"});
  gnss.rate_noise_mps =
      reader.quantity("rate_noise", gnss.rate_noise_mps, {kSpeed, "0 m/s", "100 m/s"});
  reader.finish();
  return gnss;
}

CameraDirection read_camera_direction(ObjectReader& reader, const std::string& key,
                                      const CameraDirection& fallback) {
  const json* value = reader.child(key);
  if (value == nullptr || *value == "forward") {
    return value == nullptr ? fallback : kCameraForward;
  }
  if (*value == "down") {
    return kCameraDown;
  }
  if (!value->is_object()) {
    reader.problem(key, shown(*value) +
                            " is not known; allowed: forward, down, or an object with roll, "
                            "pitch and yaw");
    return fallback;
  }
  ObjectReader angles{value, reader.path_of(key), reader.problems()};
  const QuantityRange turn{kAngle, "-180 deg", "180 deg"};
  const CameraDirection direction{.roll_rad = angles.quantity("roll", 0.0, turn),
                                  .pitch_rad = angles.quantity("pitch", 0.0, turn),
                                  .yaw_rad = angles.quantity("yaw", 0.0, turn)};
  angles.finish();
  return direction;
}

std::optional<CameraSensor> read_camera(const json* value, const std::string& path,
                                        Problems& problems) {
  if (value == nullptr ||
      is_none(value, path, "width, height, rate, field, direction and offset", problems)) {
    return std::nullopt;
  }
  CameraSensor camera;
  ObjectReader reader{value, path, problems};
  camera.width_px = reader.integer<std::uint32_t>("width", camera.width_px, {16, 1920});
  camera.height_px = reader.integer<std::uint32_t>("height", camera.height_px, {16, 1080});
  camera.period = reader.period_of_rate("rate", camera.period, "1 Hz", "60 Hz");
  camera.field_rad = reader.quantity("field", camera.field_rad, {kAngle, "10 deg", "150 deg"});
  camera.direction = read_camera_direction(reader, "direction", camera.direction);
  camera.offset_m = reader.lengths("offset", camera.offset_m);
  if (std::ranges::any_of(camera.offset_m,
                          [](double along_m) { return std::abs(along_m) > kMostOffset_m; })) {
    reader.problem("offset",
                   "is further than 2 m from the vehicle's position; allowed: -2 m ... "
                   "2 m ahead, to the left and up");
  }
  reader.finish();
  return camera;
}

VehicleSensors read_sensors(const json* value, const std::string& path, Problems& problems) {
  VehicleSensors sensors;
  ObjectReader reader{value, path, problems};
  sensors.ultrasonic =
      read_ultrasonic(reader.child("ultrasonic"), reader.path_of("ultrasonic"), problems);
  sensors.lidar = read_lidar(reader.child("lidar"), reader.path_of("lidar"), problems);
  sensors.gnss = read_gnss(reader.child("gnss"), reader.path_of("gnss"), problems);
  sensors.camera = read_camera(reader.child("camera"), reader.path_of("camera"), problems);
  reader.finish();
  return sensors;
}

}  // namespace

Vehicle read_vehicle(const json* value, const std::string& path, Problems& problems) {
  ObjectReader reader{value, path, problems};
  const bool fixed = reader.choice_index("model", {"x4", "fixed"}) == 1;
  if (value != nullptr && value->is_object() && !reader.has("model")) {
    reader.missing("model", "x4, fixed");
  }
  if (fixed) {
    reader.finish();
    return FixedVehicle{};
  }
  X4Vehicle x4;
  x4.mass_kg = reader.quantity("mass", x4.mass_kg, {kMass, "10 g", "100 kg"});
  x4.arm_m = reader.quantity("arm", x4.arm_m, {kLength, "1 cm", "10 m"});
  const json* inertia = reader.child("inertia");
  ObjectReader inertia_reader{inertia, reader.path_of("inertia"), problems};
  const QuantityRange inertia_range{kMomentOfInertia, "0.000001 kg m2", "100 kg m2"};
  x4.inertia_roll_kgm2 = inertia_reader.quantity("roll", x4.inertia_roll_kgm2, inertia_range);
  x4.inertia_pitch_kgm2 = inertia_reader.quantity("pitch", x4.inertia_pitch_kgm2, inertia_range);
  x4.inertia_yaw_kgm2 = inertia_reader.quantity("yaw", x4.inertia_yaw_kgm2, inertia_range);
  inertia_reader.finish();
  const json* drag = reader.child("drag");
  ObjectReader drag_reader{drag, reader.path_of("drag"), problems};
  const QuantityRange drag_range{kDrag, "0 N s/m", "100 N s/m"};
  x4.drag_vertical_Nspm = drag_reader.quantity("vertical", x4.drag_vertical_Nspm, drag_range);
  x4.drag_lateral_Nspm = drag_reader.quantity("lateral", x4.drag_lateral_Nspm, drag_range);
  drag_reader.finish();
  x4.motor_timeout = reader.duration("motor_timeout", x4.motor_timeout, "1 ms", "10 s");
  x4.faithful = reader.boolean("faithful", x4.faithful);
  x4.collision =
      read_collision(reader.child("collision"), reader.path_of("collision"), x4.arm_m, problems);
  x4.sensors = read_sensors(reader.child("sensors"), reader.path_of("sensors"), problems);
  reader.finish();
  return x4;
}

}  // namespace cuscus::scenario
