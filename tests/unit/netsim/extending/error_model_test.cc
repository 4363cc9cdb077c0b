#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

/// Bits that never fail above a SINR that grows with the constellation, and always below: range
/// becomes a distance, which is easy to check.
class Threshold final : public ErrorModel {
 public:
  [[nodiscard]] double bit_failure(Modulation modulation, CodeRate /*code_rate*/,
                                   double sinr_ratio) const override {
    return sinr_ratio >= needed(modulation).ratio() ? 0.0 : 1.0;
  }

 private:
  static Decibel needed(Modulation modulation) {
    switch (modulation) {
      case Modulation::kBpsk:
        return {5.0};
      case Modulation::kQpsk:
        return {10.0};
      case Modulation::k16Qam:
        return {15.0};
      default:
        return {20.0};
    }
  }
};

constexpr ErrorModelMaker kThreshold{
    .name = "threshold",
    .make = []() -> std::unique_ptr<const ErrorModel> { return std::make_unique<Threshold>(); }};

/// How many of 20 frames at 24 Mb/s (16-QAM) arrive at such a received power.
std::uint64_t arrivals(DecibelMilliwatt received) {
  struct Ignore final : AirListener {
    void delivered(const Delivery& /*delivery*/) override {}
    void finished(const FrameReport& /*report*/) override {}
  } listener;
  AirParameters parameters;
  parameters.group_rate_kbps = 24'000;
  parameters.error_model = "threshold";
  parameters.more_error_models = {kThreshold};
  parameters.nodes.assign(2, AirNode{});
  parameters.channel.model = "fixed";
  parameters.channel.reference_loss = parameters.nodes[0].tx_power - received;
  FixedPositions positions{std::vector<Eigen::Vector3d>(2, Eigen::Vector3d::Zero())};
  Air air{parameters, positions, listener};
  for (int i = 0; i < 20; ++i) {
    air.offer(0, SimTime{}, {.psdu_bytes = 200});
  }
  air.run_until(SimTime{} + std::chrono::milliseconds{100});
  return air.tally(1).received;
}

TEST_CASE("an error model of one's own is chosen by its name") {
  // Noise of k 290 K 20 MHz and 7 dB: -93.97 dBm; 16-QAM needs 15 dB more.
  CHECK(arrivals({-93.97 + 15.1}) == 20);
  CHECK(arrivals({-93.97 + 14.9}) == 0);
}

}  // namespace
}  // namespace cuscus::netsim
