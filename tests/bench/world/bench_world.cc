// Prints what a vehicle's step costs, for fleets of 10, 100 and 1000 X4 in flight: the plants
// alone, and the whole of the world's work with its shared memories.

#include <chrono>
#include <cstdio>
#include <numeric>
#include <vector>

#include "tests/unit/world/app/run_of_world.h"
#include "world/app/fleet_simulation.h"
#include "world/dynamics/flair_fleet.h"
#include "world/dynamics/quadrotor_fleet.h"

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

void measure_world(std::uint32_t vehicles) {
  std::vector<std::uint32_t> nodes(vehicles);
  std::iota(nodes.begin(), nodes.end(), 0U);
  RunOfWorld memories{vehicles, nodes};
  proto::WorldConfiguration configuration = fleet_configuration(vehicles);
  for (auto& node : *configuration.mutable_nodes()) {
    node.mutable_p_wb_start_m()->set_z(1e6);
  }
  FleetSimulation simulation{configuration, memories.map()};
  simulation.begin();
  std::uint64_t step = 0;
  const double u = hover_command(flair_x4(), 9.81);
  measure("world, memories, commands", vehicles, [&] {
    if (++step % 5 == 0) {  // agents at 200 Hz
      for (const std::uint32_t node : nodes) {
        memories.command(node, step, {u, u, u, u});
      }
    }
    simulation.step();
  });
}

}  // namespace
}  // namespace cuscus::world

int main() {
  using namespace cuscus::world;
  for (const std::uint32_t vehicles : {10U, 100U, 1000U}) {
    measure_plant<QuadrotorFleet>("corrected plant", vehicles);
    measure_plant<FlairFleet>("faithful plant", vehicles);
    measure_world(vehicles);
  }
}
