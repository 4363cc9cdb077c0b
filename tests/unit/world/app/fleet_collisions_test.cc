#include "world/app/fleet_collisions.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/world/app/run_of_world.h"
#include "tests/unit/world/blocks.h"
#include "world/app/fleet_simulation.h"

namespace cuscus::world {
namespace {

/// A house with walls at x = ±5 m and y = ±5 m and its roof at 12 m; a tower whose wall is at
/// x = 100 m.
const RunCity& town() {
  static const RunCity geometry{
      city_of({{.low_m = {-5.0, -5.0, 0.0}, .high_m = {5.0, 5.0, 12.0}},
               {.low_m = {100.0, -50.0, 0.0}, .high_m = {110.0, 50.0, 1000.0}}})};
  return geometry;
}

/// One or two vehicles of one behaviour, where they start.
proto::WorldConfiguration fleet_at(const std::vector<Eigen::Vector3d>& places,
                                   const char* behaviour) {
  proto::WorldConfiguration configuration =
      fleet_configuration(static_cast<std::uint32_t>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    proto::WorldNode& node = *configuration.mutable_nodes(static_cast<int>(i));
    node.mutable_p_wb_start_m()->set_x(places[i].x());
    node.mutable_p_wb_start_m()->set_y(places[i].y());
    node.mutable_p_wb_start_m()->set_z(places[i].z());
    node.mutable_collision()->set_behaviour(behaviour);
    node.mutable_collision()->set_restitution(0.3);
    node.mutable_collision()->set_radius_m(0.3);
  }
  return configuration;
}

proto::WorldReport report_of(const FleetSimulation& simulation) {
  proto::WorldReport report;
  simulation.collisions().report(report);
  return report;
}

TEST_CASE("a vehicle that falls onto a roof stands there, and takes off again") {
  RunOfWorld memories{1, {0}};
  FleetSimulation simulation{fleet_at({{0.0, 0.0, 12.1}}, "stop"), memories.map(), &town()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  simulation.begin();
  for (int i = 0; i < 500; ++i) {
    simulation.step();
  }
  const shm::NodeState landed = *fleet.state(0);
  for (std::uint64_t i = 0; i < 500; ++i) {
    memories.command(0, i + 1, {0.7, 0.7, 0.7, 0.7});
    simulation.step();
  }

  CHECK(landed.p_WB_m[2] == Approx(12.0).margin(1e-12));
  CHECK(landed.flags == shm::NodeFlag::kOnGround);
  CHECK(fleet.state(0)->p_WB_m[2] > 12.2);
  CHECK(report_of(simulation).collisions_size() == 0);  // 1.4 m/s: it has landed
}

TEST_CASE("a vehicle that crashes never flies again, and says what it hit") {
  RunOfWorld memories{1, {0}};
  FleetSimulation simulation{fleet_at({{1.0, 2.0, 14.0}}, "crash"), memories.map(), &town()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  std::vector<FleetCollisions::FirstContact> contacts;

  simulation.begin();
  for (std::uint64_t i = 0; i < 2000; ++i) {
    if (i > 1000) {
      memories.command(0, i, {1.0, 1.0, 1.0, 1.0});
    }
    simulation.step();
    const auto latest = simulation.collisions().first_contacts();
    contacts.insert(contacts.end(), latest.begin(), latest.end());
  }

  CHECK(fleet.state(0)->p_WB_m[2] == Approx(12.0).margin(1e-12));
  CHECK(fleet.state(0)->flags == (shm::NodeFlag::kOnGround | shm::NodeFlag::kCrashed));
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].name == "uav0");
  CHECK(contacts[0].what == "building 0");
  CHECK(contacts[0].speed_mps == Approx(std::sqrt(2.0 * 9.81 * 2.0)).epsilon(0.01));
  CHECK(contacts[0].crash);
  const proto::WorldReport report = report_of(simulation);
  REQUIRE(report.collisions_size() == 1);
  CHECK(report.collisions(0).node() == 0);
  CHECK(report.collisions(0).buildings() == 1);
  CHECK(report.collisions(0).crashed());
}

TEST_CASE("a vehicle that tilts into a wall at 50 m/s stops there, faithful or not") {
  const bool faithful = GENERATE(false, true);
  RunOfWorld memories{1, {0}};
  proto::WorldConfiguration configuration = fleet_at({{-200.0, 0.0, 600.0}}, "stop");
  configuration.mutable_nodes(0)->set_yaw_start_rad(0.0);
  configuration.mutable_nodes(0)->mutable_multirotor()->set_drag_lateral(0.0);
  configuration.mutable_nodes(0)->mutable_multirotor()->set_faithful(faithful);
  FleetSimulation simulation{configuration, memories.map(), &town()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};
  double fastest_mps = 0.0;
  double furthest_m = -200.0;

  simulation.begin();
  for (std::uint64_t i = 0; i < 12'000; ++i) {
    // Nose down for a moment and back, then full thrust at about 30 degrees.
    const double more = i < 100 ? 0.8 : 0.7;
    const double less = i >= 100 && i < 200 ? 0.8 : 0.7;
    memories.command(0, i + 1, {less, less, more, more});
    simulation.step();
    fastest_mps = std::max(fastest_mps, fleet.state(0)->v_WB_W_mps[0]);
    furthest_m = std::max(furthest_m, fleet.state(0)->p_WB_m[0]);
  }

  CHECK(fastest_mps > 50.0);
  CHECK(furthest_m == Approx(100.0 - 0.3).margin(1e-6));
  CHECK(fleet.state(0)->p_WB_m[0] == Approx(99.7).margin(1e-3));
  REQUIRE(report_of(simulation).collisions_size() == 1);
  CHECK(report_of(simulation).collisions(0).buildings() == 1);
}

TEST_CASE("of two vehicles one above the other both tell that they met") {
  RunOfWorld memories{2, {0, 1}};
  FleetSimulation simulation{fleet_at({{20.0, 0.0, 0.0}, {20.1, 0.0, 5.0}}, "bounce"),
                             memories.map()};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  simulation.begin();
  for (int i = 0; i < 3000; ++i) {
    simulation.step();
  }

  const proto::WorldReport report = report_of(simulation);
  REQUIRE(report.collisions_size() == 2);
  CHECK(report.collisions(0).vehicles() >= 1);
  CHECK(report.collisions(1).vehicles() == report.collisions(0).vehicles());
  CHECK(report.collisions(0).buildings() == 0);
  for (const std::uint32_t node : {0U, 1U}) {
    CHECK(fleet.state(node)->flags == shm::NodeFlag::kOnGround);
    CHECK(fleet.state(node)->p_WB_m[2] == 0.0);
  }
}

/// A slope that rises to the east by 1 in 5, from -200 m at x = -1000 m, and a house on it.
city::City hillside() {
  city::City city = city_of({{.low_m = {300.0, -10.0, 60.0}, .high_m = {320.0, 10.0, 90.0}}});
  city.buildings[0].osm_id = 4711;
  city.buildings[0].name = "Town Hall";
  city.terrain = city::Terrain{.south_west_m = {-1000.0, -1000.0},
                               .cell_m = 2000.0,
                               .columns = 2,
                               .rows = 2,
                               .height_m = {-200.0F, 200.0F, -200.0F, 200.0F}};
  return city;
}

TEST_CASE("starts count from the ground beneath, and what starts on a slope stands on it") {
  const RunCity city{hillside()};
  RunOfWorld memories{4, {0, 1}};
  proto::WorldConfiguration configuration =
      fleet_at({{-500.0, 0.0, 0.0}, {100.0, 50.0, 0.0}}, "stop");
  for (const std::uint32_t number : {2U, 3U}) {
    proto::WorldNode& fixed = *configuration.add_nodes();
    fixed.set_node(number);
    fixed.set_name("fixed" + std::to_string(number));
    fixed.mutable_p_wb_start_m()->set_x(250.0);
    fixed.mutable_p_wb_start_m()->set_z(number == 2 ? 0.0 : 1.5);
  }
  FleetSimulation simulation{configuration, memories.map(), &city};
  const auto mapping = memories.map_fleet();
  const shm::FleetMemoryReader fleet{mapping.bytes()};

  simulation.begin();
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
  }

  // A ball of 0.3 m on a slope of 1 in 5 touches it with its lowest point above the ground by
  // 0.3 m (1 / cos - 1), cos = 5 / sqrt(26).
  const double lift_m = 0.3 * (std::sqrt(26.0) / 5.0 - 1.0);
  CHECK(fleet.state(0)->p_WB_m[0] == Approx(-500.0));
  CHECK(fleet.state(0)->p_WB_m[2] == Approx(-100.0 + lift_m).margin(1e-5));
  CHECK(fleet.state(1)->p_WB_m[2] == Approx(20.0 + lift_m).margin(1e-5));
  CHECK(fleet.state(0)->flags == shm::NodeFlag::kOnGround);
  CHECK(fleet.state(2)->p_WB_m[2] == Approx(50.0));
  CHECK(fleet.state(2)->flags == shm::NodeFlag::kOnGround);
  CHECK(fleet.state(3)->p_WB_m[2] == Approx(51.5));
  CHECK(fleet.state(3)->flags == 0);
  CHECK(report_of(simulation).collisions_size() == 0);
}

TEST_CASE("on a hill a start below the ground is refused, and one in a house by the house's name") {
  const RunCity city{hillside()};
  const RunOfWorld memories{1, {0}};
  const auto refusal = [&](const Eigen::Vector3d& start_m) {
    try {
      const FleetSimulation simulation{fleet_at({start_m}, "stop"), memories.map(), &city};
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };

  CHECK_THAT(refusal({-500.0, 0.0, -1.0}),
             Catch::Contains("'uav0'") && Catch::Contains("not below the ground"));
  CHECK_THAT(refusal({310.0, 0.0, 5.0}),
             Catch::Contains("uav0 starts at (310.00, 0.00, 67.00) m") &&
                 Catch::Contains("building 0 (way 4711, 'Town Hall') is there"));
}

TEST_CASE("a building is called by what the map knows of it") {
  city::Building building;
  CHECK(building_label(building, 12) == "building 12");
  building.name = "Mill";
  CHECK(building_label(building, 12) == "building 12 ('Mill')");
  building.osm_id = -88;
  CHECK(building_label(building, 0) == "building 0 (relation 88, 'Mill')");
}

TEST_CASE("a start that is not free is refused with the vehicle, its place and what is there") {
  const RunOfWorld memories{2, {0, 1}};
  const auto refusal = [&](const Eigen::Vector3d& place) {
    try {
      const FleetSimulation simulation{fleet_at({{20.0, 0.0, 0.0}, place}, "stop"), memories.map(),
                                       &town()};
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };

  CHECK(refusal({5.31, 0.0, 0.0}).empty());
  CHECK_THAT(refusal({5.2, 0.0, 0.0}), Catch::Contains("uav1 starts at (5.20, 0.00, 0.00) m") &&
                                           Catch::Contains("building 0 is there") &&
                                           Catch::Contains("allowed"));
  CHECK_THAT(refusal({105.0, 0.0, 3.0}), Catch::Contains("building 1"));
}

}  // namespace
}  // namespace cuscus::world
