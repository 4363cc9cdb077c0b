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
  const RunCity wall{city_of({{.low_m = {10.0, -50.0, 0.0}, .high_m = {12.0, 50.0, 40.0}}})};
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

/// A receiver without noise, and the drift that is given, 5 times a second.
void add_gnss(proto::WorldNode& node, double drift_m) {
  proto::GnssConfiguration& gnss = *node.mutable_gnss();
  gnss.set_period_ns(200'000'000);
  gnss.set_correlation_time_ns(100'000'000'000);
  gnss.set_mask_rad(0.1);
  gnss.set_drift_m(drift_m);
}

TEST_CASE("an agent finds where satellites put it, fewer of them in a street") {
  city::City street = city_of({{.low_m = {-30.0, -5000.0, 0.0}, .high_m = {-5.0, 5000.0, 20.0}},
                               {.low_m = {15.0, -5000.0, 0.0}, .high_m = {40.0, 5000.0, 20.0}}});
  street.origin = {.latitude_deg = -33.9, .longitude_deg = 151.2, .height_m = 75.0};
  const RunCity city{street};
  proto::WorldConfiguration configuration = fleet_configuration(2);
  configuration.set_epoch_unix_s(1'767'268'800);
  configuration.mutable_nodes(0)->mutable_p_wb_start_m()->set_x(5.0);
  configuration.mutable_nodes(1)->mutable_p_wb_start_m()->set_x(30.0);
  configuration.mutable_nodes(1)->mutable_p_wb_start_m()->set_z(20.0);  // on a roof
  add_gnss(*configuration.mutable_nodes(1), 0.0);
  add_gnss(*configuration.mutable_nodes(0), 0.0);
  const RunOfWorld memories{2, {0, 1}};
  FleetSimulation simulation{configuration, memories.map(), &city};

  simulation.begin();
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
  }

  const auto below_memory = memories.map_sensors(0);
  const auto above_memory = memories.map_sensors(1);
  const auto below = shm::SensorMemoryReader{below_memory.bytes()}.gnss().value();
  const auto above = shm::SensorMemoryReader{above_memory.bytes()}.gnss().value();
  CHECK(below.sequence == 6);
  CHECK(below.sim_time_ns == 1'000'000'000);
  CHECK(above.satellites_in_view == below.satellites_in_view);
  CHECK(above.satellites_received == above.satellites_in_view);
  CHECK(below.satellites_received < below.satellites_in_view);
  REQUIRE(above.has_fix == 1);
  CHECK(above.p_WB_m[0] == Approx(30.0));
  CHECK(above.p_WB_m[2] == Approx(20.0));
  // A degree of latitude is 110.9 km here; 30 m to the east are 30 / (111.3 km cos 33.9°) degrees.
  CHECK(above.latitude_deg == Approx(-33.9).margin(1e-7));
  CHECK(above.longitude_deg == Approx(151.2 + 30.0 / (111'320.0 * 0.83)).margin(2e-6));
  CHECK(above.height_m == Approx(95.0).margin(0.001));
}

TEST_CASE("without a city the configuration tells where on Earth the fleet is") {
  proto::WorldConfiguration configuration = fleet_configuration(2);
  configuration.mutable_site()->set_latitude_deg(60.0);
  configuration.mutable_site()->set_longitude_deg(-10.0);
  configuration.mutable_site()->set_height_m(12.0);
  configuration.set_epoch_unix_s(1'767'268'800);
  add_gnss(*configuration.mutable_nodes(0), 2.0);
  const RunOfWorld memories{2, {0, 1}};
  FleetSimulation simulation{configuration, memories.map()};

  simulation.begin();

  const auto with = memories.map_sensors(0);
  const auto without = memories.map_sensors(1);
  const auto reading = shm::SensorMemoryReader{with.bytes()}.gnss().value();
  REQUIRE(reading.has_fix == 1);
  CHECK(reading.latitude_deg == Approx(60.0).margin(2e-4));
  CHECK(reading.longitude_deg == Approx(-10.0).margin(4e-4));
  CHECK(reading.height_m == Approx(12.0 + reading.p_WB_m[2]).margin(0.001));
  CHECK(std::abs(reading.p_WB_m[2]) > 0.001);
  CHECK_FALSE(shm::SensorMemoryReader{without.bytes()}.gnss());
}

TEST_CASE("memory of the wrong size for the vehicle's lidar is refused") {
  const RunOfWorld memories{1, {0}, false};

  CHECK_THROWS_WITH((FleetSimulation{with_view(), memories.map()}),
                    Catch::Contains("sensor memory"));
}

}  // namespace
}  // namespace cuscus::world
