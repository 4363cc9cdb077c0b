#include "world/collision/collisions.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/random/counter_stream.h"
#include "tests/unit/world/blocks.h"
#include "world/dynamics/quadrotor_fleet.h"

namespace cuscus::world {
namespace {

constexpr double kDrivenStep_s = 1e-3;

SimTime after(int steps) { return sim_time(std::int64_t{1'000'000} * steps); }

CollisionBody x4(CollisionBehaviour behaviour) {
  return {.radius_m = 0.3, .mass_kg = 1.2, .behaviour = behaviour, .restitution = 0.3};
}

/// Streets of 5 m between blocks of 10 m that are 12 m high.
const city::CityGeometry& blocks() {
  static const city::CityGeometry geometry{[] {
    std::vector<Block> blocks;
    for (int row = -3; row < 3; ++row) {
      for (int column = -3; column < 3; ++column) {
        const Eigen::Vector3d low{15.0 * column, 15.0 * row, 0.0};
        blocks.push_back({.low_m = low, .high_m = low + Eigen::Vector3d{10.0, 10.0, 12.0}});
      }
    }
    return city_of(blocks);
  }()};
  return geometry;
}

/// One vehicle that a test drives, without dynamics.
struct Driven {
  Driven(const CollisionBody& body, const Surroundings& surroundings, const RigidBodyState& start)
      : collisions{{body}, surroundings}, state{start} {
    collisions.place(0, start.p_WB_m);
  }

  void step(const Eigen::Vector3d& acceleration_mps2) {
    state.v_WB_W_mps += kDrivenStep_s * acceleration_mps2;
    state.p_WB_m += kDrivenStep_s * state.v_WB_W_mps;
    collisions.step({&state, 1}, after(++steps));
    for (const CollisionEvent& event : collisions.events()) {
      events.push_back(event);
    }
  }

  Collisions collisions;
  RigidBodyState state;
  int steps{0};
  std::vector<CollisionEvent> events;
};

/// Flies at random near blocks(), once with Collisions and once with a sweep in every step. Counts
/// impacts; tells whether both flights were the same, bit by bit.
bool flies_as_if_swept(std::uint64_t flight, std::size_t& impacts) {
  const double speed_mps = std::array{0.5, 8.0, 60.0, 900.0}[flight % 4];
  const random::CounterStream stream{17, flight};
  const CollisionBody body =
      x4(flight % 3 == 0 ? CollisionBehaviour::kBounce : CollisionBehaviour::kStop);
  const Surroundings city{&blocks()};
  const RigidBodyState start{.p_WB_m = {-0.35, 5.0, 0.02 + 0.3 * static_cast<double>(flight)}};
  const Eigen::Vector3d up{0.0, 0.0, body.radius_m};
  Driven kept{body, city, start};
  RigidBodyState swept = start;
  Eigen::Vector3d wish = Eigen::Vector3d::Zero();
  bool equal = true;
  for (std::uint64_t step = 0; step < 3000; ++step) {
    if (step % 250 == 0) {
      wish = speed_mps * Eigen::Vector3d{stream.normal(3 * step), stream.normal(3 * step + 1),
                                         0.3 * stream.normal(3 * step + 2)};
    }
    const Eigen::Vector3d acceleration_mps2 = 20.0 * (wish - swept.v_WB_W_mps);
    kept.step(acceleration_mps2);
    const Eigen::Vector3d from = swept.p_WB_m + up;
    swept.v_WB_W_mps += kDrivenStep_s * acceleration_mps2;
    swept.p_WB_m += kDrivenStep_s * swept.v_WB_W_mps;
    const Passage passed = passage(city, body, from, swept.p_WB_m + up, swept.v_WB_W_mps);
    impacts += passed.impact_count;
    if (passed.impact_count > 0) {
      swept.p_WB_m = passed.p_WC - up;
      swept.v_WB_W_mps = passed.v_WC_mps;
    }
    equal = equal && kept.state.p_WB_m == swept.p_WB_m && kept.state.v_WB_W_mps == swept.v_WB_W_mps;
  }
  return equal;
}

TEST_CASE("keeping the distance known to be free misses nothing that each step's sweep finds") {
  std::size_t impacts = 0;
  for (std::uint64_t flight = 0; flight < 12; ++flight) {
    CAPTURE(flight);
    CHECK(flies_as_if_swept(flight, impacts));
  }
  CHECK(impacts > 1000);
}

TEST_CASE("a fast vehicle stops at the wall of a block and the hit is told once") {
  Driven vehicle{x4(CollisionBehaviour::kStop),
                 Surroundings{&blocks()},
                 {.p_WB_m = {-2.5, 5.0, 4.0}, .v_WB_W_mps = {50.0, 0.0, 0.0}}};

  for (int step = 0; step < 1000; ++step) {
    vehicle.step({10.0, 0.0, 0.0});  // it presses on
  }

  CHECK(vehicle.state.p_WB_m.x() == Approx(-0.3).margin(1e-4));
  CHECK(vehicle.state.p_WB_m.y() == 5.0);
  REQUIRE(vehicle.events.size() == 1);
  const CollisionEvent& hit = vehicle.events[0];
  CHECK(hit.struck.kind == Struck::Kind::kBuilding);
  CHECK(hit.struck.index == 3 * 6 + 3);  // row 0, column 0 of blocks()
  CHECK(hit.speed_mps == Approx(50.45).margin(0.1));
  CHECK_FALSE(hit.crash);
}

TEST_CASE("a contact that ended is another one when it comes again") {
  Driven vehicle{
      x4(CollisionBehaviour::kBounce), Surroundings{&blocks()}, {.p_WB_m = {-1.0, 5.0, 4.0}}};

  for (int step = 0; step < 2500; ++step) {
    vehicle.step({5.0, 0.0, 0.0});
  }

  // From 0.7 m: there after 0.53 s, then 0.3 of the speed and so twice 0.3 of the time between
  // hits: 0.85 s, 0.94 s; the next comes 29 ms later, and is the same contact.
  CHECK(vehicle.events.size() == 2);
}

TEST_CASE("landing is no collision, falling is") {
  const double speed_mps = GENERATE(1.9, 2.1);
  Driven vehicle{x4(CollisionBehaviour::kCrash),
                 Surroundings{},
                 {.p_WB_m = {0.0, 0.0, 1.0}, .v_WB_W_mps = {0.5, 0.0, -speed_mps}}};

  bool rested = false;
  for (int step = 0; step < 1000 && !rested; ++step) {
    vehicle.step(Eigen::Vector3d::Zero());
    rested = !vehicle.collisions.moved().empty() && vehicle.collisions.moved()[0].rests;
  }

  CHECK(rested);
  CHECK(vehicle.state.p_WB_m.z() == 0.0);
  CHECK(vehicle.events.size() == (speed_mps < 2.0 ? 0 : 1));
  if (!vehicle.events.empty()) {
    CHECK(vehicle.events[0].crash);
    CHECK(vehicle.events[0].struck.kind == Struck::Kind::kGround);
  }
}

TEST_CASE("what lands on its side has crashed, however gently") {
  RigidBodyState tilted{.p_WB_m = {0.0, 0.0, 0.1}, .v_WB_W_mps = {0.0, 0.0, -0.2}};
  tilted.q_WB = Eigen::AngleAxisd{1.0, Eigen::Vector3d::UnitX()};
  Driven vehicle{x4(CollisionBehaviour::kCrash), Surroundings{}, tilted};

  for (int step = 0; step < 1000; ++step) {
    vehicle.step(Eigen::Vector3d::Zero());
  }

  REQUIRE(vehicle.events.size() == 1);
  CHECK(vehicle.events[0].crash);
}

TEST_CASE("vehicles that meet head-on tell both, and a crash ends the count") {
  Collisions collisions{{x4(CollisionBehaviour::kCrash), x4(CollisionBehaviour::kStop)},
                        Surroundings{}};
  std::array<RigidBodyState, 2> states{
      RigidBodyState{.p_WB_m = {0.0, 0.0, 9.0}, .v_WB_W_mps = {400.0, 0.0, 0.0}},
      RigidBodyState{.p_WB_m = {50.0, 0.0, 9.0}, .v_WB_W_mps = {-400.0, 0.0, 0.0}}};
  collisions.place(0, states[0].p_WB_m);
  collisions.place(1, states[1].p_WB_m);
  std::vector<CollisionEvent> events;

  for (int step = 1; step <= 500; ++step) {
    for (RigidBodyState& state : states) {
      state.p_WB_m += kDrivenStep_s * state.v_WB_W_mps;
    }
    collisions.step(states, after(step));
    events.insert(events.end(), collisions.events().begin(), collisions.events().end());
  }

  REQUIRE(events.size() == 2);
  CHECK(events[0].struck == Struck{.kind = Struck::Kind::kVehicle, .index = 1});
  CHECK(events[1].struck == Struck{.kind = Struck::Kind::kVehicle, .index = 0});
  CHECK(events[0].speed_mps == Approx(800.0));
  CHECK(events[0].crash);
  CHECK_FALSE(events[1].crash);
  CHECK((states[1].p_WB_m - states[0].p_WB_m).norm() == Approx(0.6).margin(1e-6));
  CHECK(states[0].p_WB_m.x() == Approx(24.7));
}

TEST_CASE("vehicles that swarm into a street never overlap by more than a step's way") {
  constexpr std::uint32_t kVehicles = 200;
  Collisions collisions{std::vector<CollisionBody>(kVehicles, x4(CollisionBehaviour::kStop)),
                        Surroundings{&blocks()}};
  std::vector<RigidBodyState> states(kVehicles);
  for (std::uint32_t i = 0; i < kVehicles; ++i) {
    states[i].p_WB_m = {-2.5 - (i % 3) + 1.0, -40.0 + (i / 9), 1.0 + (i / 3) % 3};
    states[i].v_WB_W_mps = {0.3 * (i % 5), i % 2 == 0 ? 5.0 : -5.0, 0.1 * (i % 3)};
    collisions.place(i, states[i].p_WB_m);
  }
  double nearest_m = 1.0;
  std::size_t hits = 0;

  for (int step = 1; step <= 400; ++step) {
    for (RigidBodyState& state : states) {
      state.p_WB_m += kDrivenStep_s * state.v_WB_W_mps;
    }
    collisions.step(states, after(step));
    hits += collisions.events().size();
    for (std::uint32_t a = 0; step % 5 == 0 && a < kVehicles; ++a) {
      for (std::uint32_t b = a + 1; b < kVehicles; ++b) {
        nearest_m = std::min(nearest_m, (states[a].p_WB_m - states[b].p_WB_m).norm());
      }
    }
  }

  CHECK(hits > 100);
  CHECK(nearest_m > 0.6 - 0.02);  // two at 5 m/s for two steps
}

TEST_CASE("a start within a building is seen, one on its roof stands") {
  const Collisions collisions{{x4(CollisionBehaviour::kStop)}, Surroundings{&blocks()}};

  CHECK(collisions.in_the_way(0, {5.0, 5.0, 3.0})->body == city::Body::kBuilding);
  CHECK(collisions.in_the_way(0, {-0.2, 5.0, 3.0})->body == city::Body::kBuilding);
  CHECK_FALSE(collisions.in_the_way(0, {-0.31, 5.0, 3.0}));
  CHECK_FALSE(collisions.in_the_way(0, {5.0, 5.0, 12.0}));
  CHECK(collisions.stands(0, {5.0, 5.0, 12.0}));
  CHECK(collisions.stands(0, {-2.5, -2.5, 0.0}));
  CHECK_FALSE(collisions.stands(0, {-2.5, -2.5, 0.01}));
}

}  // namespace
}  // namespace cuscus::world
