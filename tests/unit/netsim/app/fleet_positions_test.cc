#include "netsim/app/fleet_positions.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <limits>
#include <span>

namespace cuscus::netsim {
namespace {

/// Fleet memory of one node, as a world would write it.
struct OneNodeFleet {
  OneNodeFleet() : writer{bytes(), 1} {}

  std::span<std::byte> bytes() {
    return std::span{memory}.first(shm::FleetMemoryWriter::byte_size(1));
  }

  void publish(const std::array<double, 4>& q_WB) {
    shm::NodeState state{};
    state.p_WB_m = {1.0, 2.0, 3.0};
    state.q_WB = q_WB;
    writer.publish(0, state);
    writer.publish_progress(++steps, 0, 0);
  }

  alignas(4096) std::array<std::byte, 8192> memory{};
  shm::FleetMemoryWriter writer;
  std::uint64_t steps{0};
};

TEST_CASE("a node that turns on the spot counts as a change, and its attitude is seen") {
  REQUIRE(shm::FleetMemoryWriter::byte_size(1) <= sizeof(OneNodeFleet::memory));
  OneNodeFleet fleet;
  const shm::FleetMemoryReader reader{fleet.bytes()};
  FleetPositions positions{reader, 1};
  fleet.publish({1.0, 0.0, 0.0, 0.0});
  CHECK(positions.positions(SimTime{}).at(0).isApprox(Eigen::Vector3d{1.0, 2.0, 3.0}));
  const std::uint64_t level = positions.version();

  fleet.publish({0.6, 0.8, 0.0, 0.0});
  static_cast<void>(positions.positions(SimTime{}));
  CHECK(positions.version() == level);  // the same instant, so the same answer
  CHECK(positions.positions(SimTime{std::chrono::microseconds{1}})
            .at(0)
            .isApprox(Eigen::Vector3d{1.0, 2.0, 3.0}));

  CHECK(positions.version() != level);
  CHECK(positions.attitudes()[0].isApprox(Eigen::Quaterniond{0.6, 0.8, 0.0, 0.0}));
}

TEST_CASE("an attitude that is none keeps the last one") {
  OneNodeFleet fleet;
  const shm::FleetMemoryReader reader{fleet.bytes()};
  FleetPositions positions{reader, 1};
  const std::array<double, 4> bad =
      GENERATE(std::array<double, 4>{},
               std::array<double, 4>{1.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});

  fleet.publish(bad);
  static_cast<void>(positions.positions(SimTime{std::chrono::microseconds{1}}));

  CHECK(positions.attitudes()[0].isApprox(Eigen::Quaterniond::Identity()));
}

}  // namespace
}  // namespace cuscus::netsim
