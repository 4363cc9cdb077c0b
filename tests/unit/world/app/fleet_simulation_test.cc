#include "world/app/fleet_simulation.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/unit/world/app/run_of_world.h"
#include "world/app/configuration.h"
#include "world/dynamics/quadrotor_fleet.h"

namespace cuscus::world {
namespace {

void run(FleetSimulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) {
    simulation.step();
  }
}

constexpr std::array<double, 8> all_at(double u) { return {u, u, u, u}; }

TEST_CASE("every node is published where it starts, before the first step") {
  RunOfWorld memories{4, {0, 1, 2}};
  proto::WorldConfiguration configuration = fleet_configuration(3);
  proto::WorldNode& station = *configuration.add_nodes();
  station.set_node(3);
  station.mutable_p_wb_start_m()->set_z(2.0);
  const FleetSimulation simulation{configuration, memories.map()};

  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  CHECK(fleet.node_count() == 4);
  CHECK(fleet.state(2)->p_WB_m == std::array{20.0, 0.0, 0.0});
  CHECK(fleet.state(2)->q_WB[0] == Approx(std::cos(0.25)));
  CHECK(fleet.state(2)->q_WB[3] == Approx(std::sin(0.25)));
  CHECK(fleet.state(2)->flags == shm::NodeFlag::kOnGround);
  CHECK(fleet.state(3)->p_WB_m == std::array{0.0, 0.0, 2.0});
  CHECK(fleet.state(3)->flags == 0);
}

TEST_CASE("a vehicle flies by its agent's commands, from the step after it was given") {
  RunOfWorld memories{1, {0}};
  FleetSimulation simulation{fleet_configuration(1), memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  auto reference = QuadrotorFleet{std::array{flair_x4()}, {.step_s = 1e-3, .gravity_mps2 = 9.81}};
  reference.set_state(0, {.q_WB = Eigen::Quaterniond{std::cos(0.25), 0.0, 0.0, std::sin(0.25)}});

  simulation.begin();
  run(simulation, 10);
  memories.command(0, 1, all_at(0.8));
  simulation.step();  // takes it up
  CHECK((fleet.state(0)->flags & shm::NodeFlag::kMotorsRunning) == 0);
  run(simulation, 50);
  reference.set_commands(0, {0.8, 0.8, 0.8, 0.8});
  for (int i = 0; i < 50; ++i) {
    reference.step();
  }

  CHECK(fleet.state(0)->sim_time_ns == 61'000'000);
  CHECK(fleet.state(0)->flags == shm::NodeFlag::kMotorsRunning);
  CHECK(fleet.state(0)->p_WB_m[2] == reference.state(0).p_WB_m.z());
  CHECK(fleet.state(0)->p_WB_m[2] > 0.0);
}

TEST_CASE("what an agent writes that is no command is counted, and hurts nobody") {
  RunOfWorld memories{2, {0, 1}};
  FleetSimulation simulation{fleet_configuration(2), memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  simulation.begin();

  memories.command(0, 1, all_at(0.7));
  memories.command(1, 1, all_at(0.7));
  simulation.step();
  std::uint64_t sequence = 1;
  for (int i = 0; i < 40; ++i) {
    memories.command(1, ++sequence, all_at(0.7));
    memories.command(0, sequence, all_at(std::numeric_limits<double>::quiet_NaN()));
    simulation.step();
    memories.command(0, sequence + 1000, all_at(-3.0));
    simulation.step();
  }
  std::ranges::fill(memories.actuator_bytes(0), std::byte{0xff});  // version odd for ever
  run(simulation, 200);

  const shm::CommandTally tally = *fleet.commands(0);
  CHECK(tally.accepted == 1);
  CHECK(tally.rejected_not_finite == 40);
  CHECK(tally.rejected_out_of_range == 40);
  CHECK(tally.rejected_torn == 1);
  CHECK(tally.timeouts == 1);
  CHECK(std::isfinite(fleet.state(0)->p_WB_m[2]));
  CHECK(fleet.commands(1)->accepted == 41);
  CHECK(simulation.tallies()[1].commands.timeouts == 1);  // it too fell silent, 200 ms ago
}

TEST_CASE("motors stop 100 ms after the last command") {
  RunOfWorld memories{1, {0}};
  FleetSimulation simulation{fleet_configuration(1), memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  simulation.begin();
  memories.command(0, 1, all_at(0.9));

  run(simulation, 101);  // taken up at 1 ms, so given up at 101 ms
  CHECK((fleet.state(0)->flags & shm::NodeFlag::kMotorsRunning) != 0);
  simulation.step();
  CHECK((fleet.state(0)->flags & shm::NodeFlag::kMotorsRunning) == 0);
  run(simulation, 3000);

  CHECK(fleet.state(0)->flags == shm::NodeFlag::kOnGround);  // it has fallen
  CHECK(fleet.commands(0)->timeouts == 1);
}

TEST_CASE("sensors come at their rates, near the truth, to the vehicle and to the laboratory") {
  RunOfWorld memories{1, {0}};
  FleetSimulation simulation{fleet_configuration(1), memories.map()};
  const auto sensor_mapping = memories.map_sensors(0);
  const shm::SensorMemoryReader sensors{sensor_mapping.bytes()};
  const auto laboratory_mapping = memories.map_motion_capture();
  const shm::MotionCaptureMemoryReader laboratory{laboratory_mapping.bytes()};
  CHECK(sensors.imu() == std::nullopt);

  simulation.begin();
  CHECK(sensors.imu()->sequence == 1);
  CHECK(sensors.imu()->sim_time_ns == 0);
  run(simulation, 1000);

  CHECK(sensors.imu()->sequence == 201);
  CHECK(sensors.motion_capture()->sequence == 101);
  CHECK(sensors.motion_capture()->sim_time_ns == 1'000'000'000);
  CHECK(sensors.imu()->specific_force_B_mps2[2] == Approx(9.81).margin(0.6));
  CHECK(sensors.motion_capture()->p_WB_m[0] == Approx(0.0).margin(0.006));
  CHECK(laboratory.reading(0)->p_WB_m == sensors.motion_capture()->p_WB_m);
}

TEST_CASE("a period that is no multiple of the step keeps its mean rate") {
  RunOfWorld memories{1, {0}};
  proto::WorldConfiguration configuration = fleet_configuration(1);
  configuration.set_imu_period_ns(3'300'000);
  configuration.set_motion_capture_period_ns(0);
  FleetSimulation simulation{configuration, memories.map()};
  const auto mapping = memories.map_sensors(0);
  const shm::SensorMemoryReader sensors{mapping.bytes()};

  simulation.begin();
  run(simulation, 3300);

  CHECK(sensors.imu()->sequence == 1001);
  CHECK(sensors.motion_capture() == std::nullopt);  // period 0: none
}

TEST_CASE("a fixed node's time moves on") {
  RunOfWorld memories{2, {0}};
  proto::WorldConfiguration configuration = fleet_configuration(1);
  configuration.add_nodes()->set_node(1);
  FleetSimulation simulation{configuration, memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  simulation.begin();
  run(simulation, 2500);

  CHECK(fleet.state(1)->sim_time_ns == 2'000'000'000);
}

TEST_CASE("faithful and corrected vehicles fly in one fleet, each by its own equations") {
  RunOfWorld memories{2, {0, 1}};
  proto::WorldConfiguration configuration = fleet_configuration(2);
  configuration.mutable_nodes(0)->mutable_multirotor()->set_faithful(true);
  for (auto& node : *configuration.mutable_nodes()) {
    node.mutable_p_wb_start_m()->set_z(100.0);
  }
  FleetSimulation simulation{configuration, memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  simulation.begin();
  run(simulation, 1000);

  // FL-AIR's position runs half a step ahead (4.9 mm in the first second), and its vertical drag
  // pushes; the x coordinate tells which node is which.
  CHECK(fleet.state(0)->p_WB_m[0] == 0.0);
  CHECK(fleet.state(1)->p_WB_m[0] == 10.0);
  CHECK(fleet.state(0)->p_WB_m[2] < fleet.state(1)->p_WB_m[2] - 0.004);
  CHECK(fleet.state(0)->v_WB_W_mps[2] < -9.81);
  CHECK(fleet.state(1)->v_WB_W_mps[2] > -9.81);
}

TEST_CASE("a configuration that cannot be is refused by name") {
  proto::WorldConfiguration configuration = fleet_configuration(2);
  const auto refusal = [&] {
    try {
      check_configuration(configuration);
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  CHECK(refusal().empty());

  SECTION("no step") {
    configuration.set_step_ns(0);
    CHECK_THAT(refusal(), Catch::Contains("step_ns"));
  }
  SECTION("a node twice") {
    configuration.mutable_nodes(1)->set_node(0);
    CHECK_THAT(refusal(), Catch::Contains("node 0 is there twice"));
  }
  SECTION("a start below the ground") {
    configuration.mutable_nodes(1)->mutable_p_wb_start_m()->set_z(-1.0);
    CHECK_THAT(refusal(), Catch::Contains("node 1 'uav1'"));
  }
  SECTION("no mass") {
    configuration.mutable_nodes(1)->mutable_multirotor()->set_mass_kg(0.0);
    CHECK_THAT(refusal(), Catch::Contains("mass_kg"));
  }
  SECTION("no motor timeout") {
    configuration.mutable_nodes(0)->mutable_multirotor()->set_motor_timeout_ns(0);
    CHECK_THAT(refusal(), Catch::Contains("motor_timeout_ns"));
  }
  SECTION("a behaviour that is none") {
    configuration.mutable_nodes(1)->mutable_collision()->set_behaviour("melt");
    CHECK_THAT(refusal(), Catch::Contains("'uav1'") && Catch::Contains("'melt'") &&
                              Catch::Contains("stop, bounce or crash"));
  }
  SECTION("more speed after a bounce than before") {
    configuration.mutable_nodes(1)->mutable_collision()->set_behaviour("bounce");
    configuration.mutable_nodes(1)->mutable_collision()->set_restitution(1.1);
    CHECK_THAT(refusal(), Catch::Contains("restitution"));
  }
  SECTION("an ultrasonic sensor that points nowhere") {
    proto::UltrasonicConfiguration& ultrasonic =
        *configuration.mutable_nodes(0)->mutable_ultrasonic();
    ultrasonic.set_period_ns(20'000'000);
    ultrasonic.set_range_m(6.0);
    ultrasonic.set_half_angle_rad(0.2);
    CHECK_THAT(refusal(), Catch::Contains("'uav0'") && Catch::Contains("axis_B"));
  }
  SECTION("a lidar with more rays than its memory") {
    proto::LidarConfiguration& lidar = *configuration.mutable_nodes(0)->mutable_lidar();
    lidar.set_rays(3000);
    lidar.add_elevations_rad(0.0);
    lidar.add_elevations_rad(0.1);
    CHECK_THAT(refusal(), Catch::Contains("2 rows of 3000 rays") && Catch::Contains("4096"));
  }
  SECTION("a receiver that looks straight up alone") {
    proto::GnssConfiguration& gnss = *configuration.mutable_nodes(0)->mutable_gnss();
    gnss.set_period_ns(200'000'000);
    gnss.set_correlation_time_ns(1);
    gnss.set_mask_rad(1.6);
    CHECK_THAT(refusal(), Catch::Contains("'uav0'") && Catch::Contains("gnss.mask_rad"));
  }
  SECTION("a place that is not on Earth") {
    configuration.mutable_site()->set_latitude_deg(90.5);
    CHECK_THAT(refusal(), Catch::Contains("site"));
  }
  SECTION("sensors faster than the step") {
    configuration.set_imu_period_ns(10);
    CHECK_THAT(refusal(), Catch::Contains("imu_period_ns"));
  }
  SECTION("noise that is not a number") {
    configuration.set_gyro_noise_radps(std::numeric_limits<double>::quiet_NaN());
    CHECK_THAT(refusal(), Catch::Contains("noise"));
  }
}

TEST_CASE("fleet memory of another size is refused") {
  const RunOfWorld memories{3, {0, 1}};

  CHECK_THROWS_WITH((FleetSimulation{fleet_configuration(2), memories.map()}),
                    Catch::Contains("fleet memory"));
}

}  // namespace
}  // namespace cuscus::world
