#include "ground-station/core/fleet_picture.h"

#include <catch2/catch.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "proto/air.pb.h"

namespace cuscus::gcs {
namespace {

constexpr SimTime at_ms(std::int64_t ms) { return sim_time(ms * 1'000'000); }

proto::GroundStationConfiguration configuration() {
  proto::GroundStationConfiguration result;
  result.set_node(2);
  result.set_scenario_name("two and one");
  result.set_run_id("r1");
  result.set_duration_ns(60'000'000'000);
  for (std::uint32_t node = 0; node < 3; ++node) {
    auto* const item = result.add_nodes();
    item->set_node(node);
    item->set_name("node" + std::to_string(node));
    item->set_is_vehicle(node != 2);
    item->set_telemetry_period_ns(node == 1 ? 5'000'000'000 : 0);
  }
  return result;
}

bool tell(FleetPicture& picture, std::uint32_t node, std::uint32_t sequence, float x_m,
          SimTime at) {
  proto::Telemetry message;
  message.set_node(node);
  message.set_sequence(sequence);
  message.set_sim_time_ns(static_cast<std::uint64_t>(to_ns(at)));
  message.set_x_m(x_m);
  message.set_state("flying");
  const std::string bytes = message.SerializeAsString();
  return picture.receive(std::as_bytes(std::span{bytes}), at);
}

TEST_CASE("a picture shows what was said beside what is true") {
  FleetPicture picture{configuration()};
  REQUIRE(tell(picture, 1, 1, 40.0F, at_ms(1000)));
  Observation observation;
  observation.truth.resize(3);
  observation.truth[1] = Observation::Truth{.p_WB_m = {41.0, 0.0, 5.0},
                                            .v_WB_W_mps = {},
                                            .yaw_rad = 0.0,
                                            .on_ground = false,
                                            .motors_running = true};

  const Snapshot snapshot = picture.snapshot(observation, at_ms(1250), RunState::kRunning);

  REQUIRE(snapshot.nodes.size() == 3);
  CHECK_FALSE(snapshot.nodes[0].telemetry);
  CHECK_FALSE(snapshot.nodes[0].truth);
  CHECK(snapshot.nodes[1].telemetry->sample.p_WB_m[0] == 40.0);
  CHECK(snapshot.nodes[1].telemetry->age == std::chrono::milliseconds{250});
  CHECK(snapshot.nodes[1].truth->p_WB_m[0] == 41.0);
  CHECK(snapshot.nodes[1].telemetry_period == std::chrono::seconds{5});
  CHECK(snapshot.nodes[1].hears == 0);
  CHECK(snapshot.scenario_name == "two and one");
  CHECK_FALSE(snapshot.circle);
  CHECK(snapshot.telemetry_received == 1);
}

TEST_CASE("overtaken telemetry counts as received but does not move a UAV back") {
  FleetPicture picture{configuration()};
  tell(picture, 0, 1, 1.0F, at_ms(100));
  tell(picture, 0, 3, 3.0F, at_ms(300));
  tell(picture, 0, 2, 2.0F, at_ms(200));
  tell(picture, 0, 3, 99.0F, at_ms(300));  // the same number again

  const auto snapshot = picture.snapshot({}, at_ms(400), RunState::kRunning);

  CHECK(snapshot.nodes[0].telemetry->sample.p_WB_m[0] == 3.0);
  CHECK(snapshot.nodes[0].telemetry->received == 3);
  CHECK(snapshot.nodes[0].telemetry->loss_ratio == 0.0);
}

TEST_CASE("telemetry of a node that is no UAV of the fleet is counted and ignored") {
  FleetPicture picture{configuration()};

  CHECK_FALSE(tell(picture, 7, 1, 1.0F, at_ms(100)));
  CHECK_FALSE(tell(picture, 2, 1, 1.0F, at_ms(100)));  // the ground station flies nowhere
  CHECK_FALSE(tell(picture, 0, 1, std::numeric_limits<float>::quiet_NaN(), at_ms(100)));
  const std::string garbage = "\xFF\xFF\xFF\xFFgarbage";
  CHECK_FALSE(picture.receive(std::as_bytes(std::span{garbage}), at_ms(100)));

  CHECK(picture.received() == 0);
  CHECK(picture.rejected() == 4);
  CHECK(picture.rejected(TelemetryFault::kUnknownNode) == 2);
  CHECK(picture.rejected(TelemetryFault::kNotFinite) == 1);
  CHECK(picture.rejected(TelemetryFault::kMalformed) == 1);
}

TEST_CASE("a configuration that names a node twice is refused") {
  auto twice = configuration();
  twice.add_nodes()->set_node(1);

  CHECK_THROWS_AS(FleetPicture{twice}, std::invalid_argument);
}

}  // namespace
}  // namespace cuscus::gcs
