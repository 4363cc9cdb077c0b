#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/unit/world/app/run_of_world.h"
#include "tests/unit/world/blocks.h"
#include "world/app/fleet_simulation.h"

namespace cuscus::world {
namespace {

/// One vehicle with both sensors, without noise, 2 m above the ground and 4 m west of a wall.
proto::WorldConfiguration with_view() {
  proto::WorldConfiguration configuration = fleet_configuration(1);
  proto::WorldNode& node = *configuration.mutable_nodes(0);
  node.set_yaw_start_rad(0.0);
  node.mutable_p_wb_start_m()->set_x(6.0);
  node.mutable_p_wb_start_m()->set_z(2.0);
  proto::UltrasonicConfiguration& ultrasonic = *node.mutable_ultrasonic();
  ultrasonic.set_period_ns(20'000'000);
  ultrasonic.set_range_m(6.0);
  ultrasonic.set_half_angle_rad(0.25);
  ultrasonic.mutable_axis_b()->set_z(-1.0);
  proto::LidarConfiguration& lidar = *node.mutable_lidar();
  lidar.set_period_ns(100'000'000);
  lidar.set_rays(4);
  lidar.set_field_rad(2.0 * std::numbers::pi);
  lidar.add_elevations_rad(0.0);
  lidar.add_elevations_rad(0.5);
  lidar.set_range_m(30.0);
  return configuration;
}

TEST_CASE("an agent finds what the vehicle's sensors see in its memory, each at its rate") {
  const city::CityGeometry wall{
      city_of({{.low_m = {10.0, -50.0, 0.0}, .high_m = {12.0, 50.0, 40.0}}})};
  RunOfWorld memories{1, {0}, true};
  FleetSimulation simulation{with_view(), memories.map(), &wall};
  const auto mapping = memories.map_sensors(0);
  const shm::SensorMemoryReader sensors{mapping.bytes()};
  CHECK_FALSE(sensors.ultrasonic());
  CHECK_FALSE(sensors.lidar());

  simulation.begin();
  const auto first = sensors.lidar().value();
  const double height_m = sensors.ultrasonic()->distance_m;
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
  }

  CHECK(height_m == Approx(2.04));
  CHECK(first.rows == 2);
  CHECK(first.rays == 4);
  CHECK(first.first_azimuth_rad == Approx(-std::numbers::pi));
  CHECK(first.azimuth_step_rad == Approx(std::numbers::pi / 2.0));
  CHECK(first.elevation_rad[1] == 0.5F);
  CHECK(std::isinf(first.range_m[0]));  // behind
  CHECK(first.range_m[2] == Approx(4.0));
  CHECK(first.range_m[6] == Approx(4.0 / std::cos(0.5)));
  CHECK(sensors.ultrasonic()->sequence == 51);
  CHECK(sensors.lidar()->sequence == 11);
  CHECK(sensors.lidar()->sim_time_ns == 1'000'000'000);
  CHECK(sensors.ultrasonic()->distance_m == Approx(0.04));  // it has fallen
}

TEST_CASE("memory of the wrong size for the vehicle's lidar is refused") {
  const RunOfWorld memories{1, {0}, false};

  CHECK_THROWS_WITH((FleetSimulation{with_view(), memories.map()}),
                    Catch::Contains("sensor memory"));
}

}  // namespace
}  // namespace cuscus::world
