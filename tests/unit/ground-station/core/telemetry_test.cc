#include "ground-station/core/telemetry.h"

#include <google/protobuf/stubs/logging.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <variant>

#include "proto/air.pb.h"

namespace cuscus::gcs {
namespace {

constexpr SimTime kNow = sim_time(5'000'000'000);

proto::Telemetry good() {
  proto::Telemetry message;
  message.set_node(3);
  message.set_sequence(17);
  message.set_sim_time_ns(4'900'000'000);
  message.set_x_m(1.5F);
  message.set_y_m(-2.5F);
  message.set_z_m(10.0F);
  message.set_vx_mps(3.0F);
  message.set_yaw_rad(0.5F);
  message.set_state("flying");
  message.set_neighbours_heard(9);
  return message;
}

std::variant<TelemetrySample, TelemetryFault> decode(const std::string& bytes) {
  return decode_telemetry(std::as_bytes(std::span{bytes}), kNow);
}

TelemetryFault fault_of(const proto::Telemetry& message) {
  return std::get<TelemetryFault>(decode(message.SerializeAsString()));
}

TEST_CASE("telemetry is read with its time, place, motion and state") {
  const auto sample = std::get<TelemetrySample>(decode(good().SerializeAsString()));

  CHECK(sample.node == 3);
  CHECK(sample.sequence == 17);
  CHECK(to_ns(sample.at) == 4'900'000'000);
  CHECK(sample.p_WB_m == std::array{1.5, -2.5, 10.0});
  CHECK(sample.v_WB_W_mps == std::array{3.0, 0.0, 0.0});
  CHECK(sample.yaw_rad == 0.5);
  CHECK(sample.state == "flying");
  CHECK(sample.neighbours_heard == 9);
}

TEST_CASE("numbers that are none, or that no UAV can have, are refused") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  auto message = good();

  SECTION("a position that is not a number") {
    message.set_y_m(kNan);
    CHECK(fault_of(message) == TelemetryFault::kNotFinite);
  }
  SECTION("an infinite velocity") {
    message.set_vz_mps(-kInfinity);
    CHECK(fault_of(message) == TelemetryFault::kNotFinite);
  }
  SECTION("a heading that is not a number") {
    message.set_yaw_rad(kNan);
    CHECK(fault_of(message) == TelemetryFault::kNotFinite);
  }
  SECTION("a position beyond the world") {
    message.set_x_m(2e6F);
    CHECK(fault_of(message) == TelemetryFault::kOutOfRange);
  }
  SECTION("a velocity beyond any rotor") {
    message.set_vx_mps(1e9F);
    CHECK(fault_of(message) == TelemetryFault::kOutOfRange);
  }
  SECTION("a heading that is no angle") {
    message.set_yaw_rad(1e6F);
    CHECK(fault_of(message) == TelemetryFault::kOutOfRange);
  }
}

TEST_CASE("a time that has not come yet is refused") {
  auto message = good();

  message.set_sim_time_ns(6'000'000'000);
  CHECK(fault_of(message) == TelemetryFault::kFromTheFuture);
  message.set_sim_time_ns(
      std::numeric_limits<std::uint64_t>::max());  // negative as a signed number
  CHECK(fault_of(message) == TelemetryFault::kFromTheFuture);
}

TEST_CASE("a state is a short word and nothing else") {
  auto message = good();

  for (const char* const state :
       {"", "<script>", "Flying", "fly ing", "flying\n", "a-state-of-twenty-five-xx"}) {
    message.set_state(state);
    CHECK(fault_of(message) == TelemetryFault::kBadState);
  }
  message.set_state("taking-off");
  CHECK(std::holds_alternative<TelemetrySample>(decode(message.SerializeAsString())));
}

TEST_CASE("an empty datagram, a cut one and an overlong one are refused") {
  const std::string bytes = good().SerializeAsString();

  CHECK(std::get<TelemetryFault>(decode("")) == TelemetryFault::kBadState);
  CHECK(std::get<TelemetryFault>(decode(bytes.substr(0, bytes.size() - 4))) ==
        TelemetryFault::kMalformed);
  // An unknown field of 600 B: a valid message, but none of ours.
  const std::string padding = std::string{"\xFA\x07\xD8\x04", 4} + std::string(600, 'x');
  CHECK(std::get<TelemetryFault>(decode(bytes + padding)) == TelemetryFault::kMalformed);
}

TEST_CASE("any bytes whatsoever give a checked sample or a fault") {
  const google::protobuf::LogSilencer quiet;  // it complains about every broken string
  const std::string original = good().SerializeAsString();
  std::uint64_t state = 20'240'601;  // SplitMix64 (Steele, Lea, Flood, OOPSLA 2014)
  const auto next = [&state] {
    std::uint64_t z = (state += 0x9E37'79B9'7F4A'7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58'476D'1CE4'E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D0'49BB'1331'11EBU;
    return z ^ (z >> 31U);
  };
  for (int round = 0; round < 20'000; ++round) {
    std::string bytes = original;
    if (round % 2 == 0) {
      bytes.assign(next() % 100, '\0');
    }
    const std::size_t changes = round % 2 == 0 ? bytes.size() : 1 + next() % 4;
    for (std::size_t i = 0; i < changes; ++i) {
      bytes[round % 2 == 0 ? i : next() % bytes.size()] = static_cast<char>(next());
    }
    const auto decoded = decode(bytes);
    if (const auto* const sample = std::get_if<TelemetrySample>(&decoded)) {
      REQUIRE(std::abs(sample->p_WB_m[0]) <= kFarthest_m);
      REQUIRE(std::abs(sample->v_WB_W_mps[2]) <= kFastest_mps);
      REQUIRE(std::isfinite(sample->yaw_rad));
      REQUIRE_FALSE(sample->state.empty());
    }
  }
}

}  // namespace
}  // namespace cuscus::gcs
