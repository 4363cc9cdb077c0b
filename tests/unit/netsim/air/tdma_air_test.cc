#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

constexpr std::uint32_t kSlotNodes = 4;
constexpr std::uint32_t kSlotPsdu_bytes = 128;
constexpr Duration kSlotAirtime = std::chrono::microseconds{202};  // at 6 Mb/s, 802.11g

AirParameters tdma_air() {
  AirParameters p;
  p.mac = "tdma";
  p.tdma.slot = std::chrono::milliseconds{1};
  p.nodes.assign(kSlotNodes, AirNode{});
  return p;
}

/// Nodes within 30 m that always have a frame to send.
class Saturated final : public AirListener {
 public:
  explicit Saturated(const AirParameters& parameters)
      : positions_{{{0.0, 0.0, 9.0}, {10.0, 0.0, 9.0}, {20.0, 0.0, 9.0}, {30.0, 0.0, 9.0}}},
        air{parameters, positions_, *this} {
    for (std::uint32_t node = 0; node < kSlotNodes; ++node) {
      air.offer(node, SimTime{}, {.psdu_bytes = kSlotPsdu_bytes});
      air.offer(node, SimTime{}, {.psdu_bytes = kSlotPsdu_bytes});
    }
  }
  void delivered(const Delivery& delivery) override { deliveries.push_back(delivery); }
  void finished(const FrameReport& report) override {
    air.offer(report.sender, air.now(), {.psdu_bytes = report.psdu_bytes});
  }

 private:
  FixedPositions positions_;

 public:
  std::vector<Delivery> deliveries;
  Air air;
};

TEST_CASE("saturated nodes fill their slots, and no two transmissions ever overlap") {
  Saturated field{tdma_air()};

  field.air.run_until(SimTime{} + std::chrono::milliseconds{100} - Duration{1});

  // 25 slots each, floor((1000 - 10) / 202) = 4 frames in each, all of them heard by all others.
  for (std::uint32_t node = 0; node < kSlotNodes; ++node) {
    const Tally& tally = field.air.tally(node);
    CHECK(tally.transmissions == 25 * 4);
    CHECK(tally.sent == 25 * 4);
    CHECK(tally.received == 3 * 25 * 4);
    CHECK(tally.lost_collision + tally.lost_interference + tally.lost_half_duplex +
              tally.lost_noise ==
          0);
  }
  // At one receiver frames end at least an airtime apart, but for the differences of propagation
  // delay (100 ns at most).
  std::vector<SimTime> ends;
  for (const Delivery& delivery : field.deliveries) {
    if (delivery.receiver == 0) {
      ends.push_back(delivery.time);
    }
  }
  REQUIRE(std::is_sorted(ends.begin(), ends.end()));
  for (std::size_t i = 1; i < ends.size(); ++i) {
    CHECK(ends[i] - ends[i - 1] >= kSlotAirtime - Duration{100});
  }
}

TEST_CASE("a node without a slot is silent, and a slot without owner stays empty") {
  AirParameters parameters = tdma_air();
  parameters.tdma.frame = {0, kNobody, 2, 0};
  Saturated field{parameters};

  field.air.run_until(SimTime{} + std::chrono::milliseconds{40} - Duration{1});

  CHECK(field.air.tally(0).transmissions == 2 * 10 * 4);
  CHECK(field.air.tally(1).transmissions == 0);
  CHECK(field.air.tally(2).transmissions == 10 * 4);
  for (const Delivery& delivery : field.deliveries) {
    CHECK((delivery.time - SimTime{}) / std::chrono::milliseconds{1} % 4 != 1);
  }
}

TEST_CASE("a frame that fits into no slot is counted as such") {
  struct Ignore final : AirListener {
    void delivered(const Delivery& /*delivery*/) override {}
    void finished(const FrameReport& report) override { outcome = report.outcome; }
    SendOutcome outcome{};
  } listener;
  FixedPositions positions{std::vector<Eigen::Vector3d>(kSlotNodes, Eigen::Vector3d::Zero())};
  Air air{tdma_air(), positions, listener};

  air.offer(0, SimTime{}, {.psdu_bytes = 1536});
  air.run_until(SimTime{});

  CHECK(listener.outcome == SendOutcome::kTooLong);
  CHECK(air.tally(0).dropped_too_long == 1);
}

TEST_CASE("a schedule that cannot be is refused with what is allowed") {
  const auto error_of = [](const auto& change) {
    AirParameters parameters = tdma_air();
    change(parameters);
    try {
      Saturated field{parameters};
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };

  CHECK_THAT(error_of([](AirParameters& p) { p.tdma.frame = {4}; }),
             Catch::Contains("owner 4; allowed: -2 for none, 0 ... 3"));
  CHECK_THAT(error_of([](AirParameters& p) { p.tdma.guard = p.tdma.slot; }),
             Catch::Contains("its slot must be longer"));
  CHECK_THAT(error_of([](AirParameters& p) { p.rate_control = "aarf"; }),
             Catch::Contains("'aarf' needs ACKs"));
  CHECK_THAT(error_of([](AirParameters& p) { p.mac = "aloha"; }),
             Catch::Contains("allowed are 'dcf', 'edca', 'tdma'"));
}

}  // namespace
}  // namespace cuscus::netsim
