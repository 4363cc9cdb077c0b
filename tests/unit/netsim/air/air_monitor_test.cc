#include "netsim/air/air_monitor.h"

#include <catch2/catch.hpp>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

SimTime after(std::int64_t us) { return SimTime{} + microseconds{us}; }

class Nobody final : public AirListener {
 public:
  void delivered(const Delivery& /*delivery*/) override {}
  void finished(const FrameReport& /*report*/) override {}
};

struct Seen final : public AirMonitor {
  void transmitted(const Ppdu& ppdu) override { ppdus.push_back(ppdu); }
  void received(const Ppdu& ppdu, const Reception& reception) override {
    receptions.push_back(reception);
    of.push_back(ppdu);
  }

  std::vector<Ppdu> ppdus;
  std::vector<Reception> receptions;
  std::vector<Ppdu> of;  ///< Of each reception.
};

/// Nodes on a line and all that a monitor sees of their air.
struct Watched {
  explicit Watched(const std::vector<double>& x_m, AirParameters parameters = {})
      : positions{on_x_axis(x_m)},
        air{with_nodes(parameters, x_m.size()), positions, nobody, &seen} {}

  static std::vector<Eigen::Vector3d> on_x_axis(const std::vector<double>& x_m) {
    std::vector<Eigen::Vector3d> positions;
    positions.reserve(x_m.size());
    for (const double x : x_m) {
      positions.emplace_back(x, 0.0, 20.0);
    }
    return positions;
  }
  static AirParameters with_nodes(AirParameters& parameters, std::size_t nodes) {
    parameters.nodes.assign(nodes, AirNode{});
    return parameters;
  }

  FixedPositions positions;
  Nobody nobody;
  Seen seen;
  Air air;
};

TEST_CASE("a monitor sees a data frame and its ACK, and each at the other end") {
  Watched field{{0.0, 30.0}};

  field.air.offer(0, after(1000), {.id = 7, .destination = 1, .psdu_bytes = 128});
  field.air.run_until(after(5000));

  REQUIRE(field.seen.ppdus.size() == 2);
  const Ppdu& data = field.seen.ppdus[0];
  CHECK(data.frame.kind == MacFrame::Kind::kData);
  CHECK(data.offer_id == 7);
  CHECK(data.attempt == 1);
  CHECK(data.mode->rate_kbps == 6'000);
  CHECK(data.psdu_bytes == 128);
  CHECK(data.begins == after(1050));  // DIFS
  CHECK(data.ends - data.begins == airtime(*data.mode, 128));
  CHECK(field.seen.ppdus[1].frame.kind == MacFrame::Kind::kAck);
  CHECK(field.seen.ppdus[1].frame.sender == 1);
  REQUIRE(field.seen.receptions.size() == 2);
  const Reception& reception = field.seen.receptions[0];
  CHECK(reception.receiver == 1);
  CHECK(reception.cause == LossCause::kNone);
  CHECK(reception.interferer == kNoSender);
  // Friis at 2.412 GHz and 30 m: 16.02 dBm - 69.64 dB, over -93.97 dBm of noise.
  CHECK(reception.power.value == Approx(-53.62).margin(0.01));
  CHECK(reception.sinr.value == Approx(-53.62 + 93.97).margin(0.01));
  CHECK(reception.time == data.ends + std::chrono::nanoseconds{100});  // 30 m
}

TEST_CASE("a monitor is told of each attempt, and of none at a node below the floor") {
  // Below the floor of -114 dBm beyond 31 km.
  Watched field{{0.0, 100'000.0}};

  field.air.offer(0, after(0), {.destination = 1, .psdu_bytes = 128});
  field.air.run_until(after(1'000'000));

  REQUIRE(field.seen.ppdus.size() == 7);
  for (std::uint32_t i = 0; i < 7; ++i) {
    CHECK(field.seen.ppdus[i].attempt == i + 1);
    CHECK(field.seen.ppdus[i].number == i);
  }
  CHECK(field.seen.receptions.empty());
}

TEST_CASE("of two frames that begin at once each names the other") {
  // Both ends find the medium idle and send after DIFS, at equal distance of the one between them.
  Watched field{{0.0, 30.0, 60.0}};

  field.air.offer(0, after(0), {.psdu_bytes = 128});
  field.air.offer(2, after(0), {.psdu_bytes = 128});
  field.air.run_until(after(5000));

  std::size_t between = 0;
  for (std::size_t i = 0; i < field.seen.receptions.size(); ++i) {
    const Reception& reception = field.seen.receptions[i];
    const std::uint32_t sender = field.seen.of[i].frame.sender;
    if (reception.receiver == 1) {
      ++between;
      CHECK(reception.cause == LossCause::kCollision);
      CHECK(reception.interferer == 2 - sender);
      CHECK(reception.sinr.value == Approx(0.0).margin(0.01));
    } else {
      CHECK(reception.cause == LossCause::kHalfDuplex);
    }
  }
  CHECK(between == 2);
}

TEST_CASE("an air that is watched does what it does unwatched") {
  const std::vector<double> x_m{0.0, 200.0, 400.0, 600.0, 800.0, 1'000.0};
  AirParameters parameters;
  parameters.channel.fading = "rice";
  Watched watched{x_m, parameters};
  FixedPositions positions{Watched::on_x_axis(x_m)};
  Nobody nobody;
  Air unwatched{Watched::with_nodes(parameters, x_m.size()), positions, nobody};

  for (int i = 0; i < 600; ++i) {
    const auto node = static_cast<std::uint32_t>(i) % 6;
    const std::int32_t destination =
        i % 3 == 0 ? kGroup : static_cast<std::int32_t>((node + 1) % 6);
    for (Air* air : {&watched.air, &unwatched}) {
      air->offer(node, after(std::int64_t{i} * 150),
                 {.destination = destination, .psdu_bytes = 200});
    }
  }
  watched.air.run_until(after(1'000'000));
  unwatched.run_until(after(1'000'000));

  CHECK(watched.air.events() == unwatched.events());
  std::uint64_t received = 0;
  for (std::uint32_t node = 0; node < x_m.size(); ++node) {
    CHECK(watched.air.tally(node).received == unwatched.tally(node).received);
    CHECK(watched.air.tally(node).lost_interference == unwatched.tally(node).lost_interference);
    received += unwatched.tally(node).received;
  }
  CHECK(received > 0);
}

}  // namespace
}  // namespace cuscus::netsim
