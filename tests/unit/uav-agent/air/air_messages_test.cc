#include "uav-agent/air/air_messages.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "common/random/counter_stream.h"
#include "proto/air.pb.h"

namespace cuscus::air {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span{text});
}

Beacon beacon() {
  return {.report = {.slot = 3,
                     .sequence = 41,
                     .time = sim_time(12'345'678'901),
                     .p_WB_m = {12.5, -7.25, 10.0}},
          .q_WB = {0.8, 0.0, 0.6, 0.0}};
}

TEST_CASE("a beacon arrives as it was sent") {
  const auto received = decoded(bytes_of(encoded(beacon())));

  REQUIRE(received);
  CHECK(received->report.slot == 3);
  CHECK(received->report.sequence == 41);
  CHECK(received->report.time == sim_time(12'345'678'901));
  CHECK(received->report.p_WB_m == Eigen::Vector3d{12.5, -7.25, 10.0});
  CHECK(received->q_WB.angularDistance(beacon().q_WB) < 1e-6);
}

TEST_CASE("the longest beacon keeps within its limit") {
  Beacon longest = beacon();
  longest.report.slot = std::numeric_limits<std::uint32_t>::max();
  longest.report.sequence = std::numeric_limits<std::uint32_t>::max();
  longest.report.time = sim_time(std::numeric_limits<std::int64_t>::max());
  longest.report.p_WB_m = {-99999.9, 99999.9, -0.1};
  longest.q_WB = {0.5, 0.5, 0.5, -0.5};

  // Two varints of 1 + 5 B, a fixed64 of 1 + 8 B, seven floats of 1 + 4 B.
  CHECK(encoded(longest).size() == 2 * 6 + 9 + 7 * 5);
  CHECK(encoded(longest).size() <= kBeaconBytesMax);
  CHECK(decoded(bytes_of(encoded(longest))));
}

TEST_CASE("random bytes are no beacon and do no harm") {
  const random::CounterStream stream{11, 1};
  std::uint64_t draws = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> garbage(stream.below(draws++, 120));
    for (auto& byte : garbage) {
      byte = static_cast<std::byte>(stream.below(draws++, 256));
    }
    CHECK_FALSE(decoded(garbage));
  }
}

TEST_CASE("a beacon with any byte changed is refused, or has numbers that the table can judge") {
  const std::string sent = encoded(beacon());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string changed = sent;
      changed[i] = static_cast<char>(value);
      missions::NeighbourTable table{0, 10, std::chrono::seconds{1}};
      const auto received = decoded(bytes_of(changed));
      if (received && table.accept(received->report, sim_time(12'400'000'000)) ==
                          missions::NeighbourTable::Verdict::kAccepted) {
        CHECK(received->report.p_WB_m.allFinite());
        CHECK(received->report.slot < 10);
      }
    }
  }
}

TEST_CASE("what is empty, cut off, too long or of no direction is no beacon") {
  const std::string sent = encoded(beacon());

  CHECK_FALSE(decoded({}));
  CHECK_FALSE(decoded(bytes_of(sent.substr(0, sent.size() - 1))));
  CHECK_FALSE(decoded(bytes_of(sent + std::string(100, '\0'))));
  Beacon twisted = beacon();
  twisted.q_WB.coeffs().setZero();
  CHECK_FALSE(decoded(bytes_of(encoded(twisted))));
  twisted.q_WB.coeffs().setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK_FALSE(decoded(bytes_of(encoded(twisted))));
}

TEST_CASE("telemetry says where a vehicle is and what it does") {
  TelemetryReport report{.node = 4,
                         .sequence = 9,
                         .estimate = {},
                         .yaw_rad = 0.5,
                         .state = "flying",
                         .neighbours_heard = 8};
  report.estimate.time = sim_time(77);
  report.estimate.p_WB_m = {1.0, 2.0, 3.0};
  report.estimate.v_WB_mps = {4.0, 5.0, 6.0};

  proto::Telemetry message;
  REQUIRE(message.ParseFromString(encoded(report)));

  CHECK(message.node() == 4);
  CHECK(message.sequence() == 9);
  CHECK(message.sim_time_ns() == 77);
  CHECK(message.z_m() == 3.0F);
  CHECK(message.vy_mps() == 5.0F);
  CHECK(message.yaw_rad() == 0.5F);
  CHECK(message.state() == "flying");
  CHECK(message.neighbours_heard() == 8);
}

}  // namespace
}  // namespace cuscus::air
