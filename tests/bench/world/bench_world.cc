// Prints what a vehicle's step costs, for fleets of 10, 100 and 1000 X4 in flight: the plants
// alone, and the whole of the world's work with its shared memories, over the bare ground and over
// a city in which all can collide.

#include <chrono>
#include <cstdio>
#include <numeric>
#include <vector>

#include "tests/unit/world/app/run_of_world.h"
#include "tests/unit/world/blocks.h"
#include "world/app/fleet_simulation.h"
#include "world/dynamics/flair_fleet.h"
#include "world/dynamics/quadrotor_fleet.h"
#include "world/sensors/gnss.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {
namespace {

constexpr double kStepsPerSecond = 1000.0;
constexpr double kStepsOfVehicles = 2e6;

/// Calls `step` so often that every row does the same work; prints ns per vehicle and step.
template <typename Step>
void measure(const char* name, std::uint32_t vehicles, Step step) {
  const auto steps = static_cast<int>(kStepsOfVehicles / vehicles);
  for (int i = 0; i < steps / 10; ++i) {
    step();
  }
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i) {
    step();
  }
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
  const double per_vehicle_ns = spent.count() / steps / vehicles;
  std::printf("%-28s %5u vehicles  %8.1f ns per vehicle and step  %7.4f of a core at 1 kHz\n", name,
              vehicles, per_vehicle_ns, per_vehicle_ns * 1e-9 * vehicles * kStepsPerSecond);
}

template <typename Fleet>
void measure_plant(const char* name, std::uint32_t vehicles) {
  const std::vector<MultirotorParameters> parameters(vehicles, flair_x4());
  Fleet fleet{parameters, PlantSettings{.step_s = 1e-3, .gravity_mps2 = 9.81}};
  const double u = hover_command(flair_x4(), 9.81);
  for (std::size_t i = 0; i < vehicles; ++i) {
    fleet.set_state(i, {.p_WB_m = {0.0, 0.0, 1e6}});
    fleet.set_commands(i, {u * 1.0001, u, u, u});
  }
  measure(name, vehicles, [&] { fleet.step(); });
}

/// 1 600 blocks of 12 m, between streets of 5 m.
RunCity blocks() {
  std::vector<Block> blocks;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      const Eigen::Vector3d low{15.0 * column, 15.0 * row, 0.0};
      blocks.push_back({.low_m = low, .high_m = low + Eigen::Vector3d{10.0, 10.0, 12.0}});
    }
  }
  return RunCity{city_of(blocks)};
}

/// Hovering, 10 m apart; in a city 50 m above the ground.
void measure_world(const char* name, std::uint32_t vehicles, const RunCity* city) {
  std::vector<std::uint32_t> nodes(vehicles);
  std::iota(nodes.begin(), nodes.end(), 0U);
  RunOfWorld memories{vehicles, nodes};
  proto::WorldConfiguration configuration = fleet_configuration(vehicles);
  for (auto& node : *configuration.mutable_nodes()) {
    node.mutable_p_wb_start_m()->set_z(city == nullptr ? 1e6 : 50.0);
    if (city != nullptr) {
      node.mutable_collision()->set_behaviour("stop");
      node.mutable_collision()->set_radius_m(0.3);
    }
  }
  FleetSimulation simulation{configuration, memories.map(), city};
  simulation.begin();
  std::uint64_t step = 0;
  const double u = hover_command(flair_x4(), 9.81);
  measure(name, vehicles, [&] {
    if (++step % 5 == 0) {  // agents at 200 Hz
      for (const std::uint32_t node : nodes) {
        memories.command(node, step, {u, u, u, u});
      }
    }
    simulation.step();
  });
}

/// A reading of satellite navigation on the street between blocks, and without a city.
void measure_gnss(const char* name, const RunCity* city) {
  const Constellation sky{{.latitude_deg = 49.4, .longitude_deg = 2.8, .height_m = 40.0}, {}};
  Gnss gnss{1, 0, {}, sky};
  const Surroundings surroundings =
      city != nullptr ? Surroundings{&city->geometry} : Surroundings{};
  const RigidBodyState body{.p_WB_m = {312.5, 305.0, 1.5}};
  constexpr std::uint64_t kReadings = 100'000;
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t received = 0;
  for (std::uint64_t k = 0; k < kReadings; ++k) {
    const SimTime time = sim_time(static_cast<std::int64_t>(k) * 200'000'000);
    received += gnss.sample(surroundings, body, time, k).received;
  }
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begin;
  std::printf("%-28s %8.2f us per reading, %.1f satellites received\n", name,
              spent.count() / kReadings, static_cast<double>(received) / kReadings);
}

}  // namespace
}  // namespace cuscus::world

int main() {
  using namespace cuscus::world;
  const cuscus::world::RunCity city = blocks();
  measure_gnss("GNSS in the open", nullptr);
  measure_gnss("GNSS in a city", &city);
  for (const std::uint32_t vehicles : {10U, 100U, 1000U}) {
    measure_plant<QuadrotorFleet>("corrected plant", vehicles);
    measure_plant<FlairFleet>("faithful plant", vehicles);
    measure_world("world, memories, commands", vehicles, nullptr);
    measure_world("the same in a city", vehicles, &city);
  }
}
