#include <catch2/catch.hpp>
#include <cmath>
#include <deque>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

/// Pure ALOHA: a station sends when it has something to send, and hopes.
class Aloha final : public Mac {
 public:
  explicit Aloha(const MacSetting& setting) : setting_{setting} {}

  void enqueue(SimTime /*now*/, const Msdu& msdu) override {
    queue_.push_back(msdu);
    if (queue_.size() == 1) {
      send();
    }
  }
  void transmission_ended(SimTime /*now*/) override {
    const Msdu done = queue_.front();
    queue_.pop_front();
    if (!queue_.empty()) {
      send();
    }
    setting_.host->finished(setting_.node, done, SendOutcome::kSent, 1);
  }
  bool received(SimTime /*now*/, const MacFrame& frame, const Mode& /*mode*/) override {
    return frame.receiver == kGroup || frame.receiver == static_cast<std::int32_t>(setting_.node);
  }
  // It does not listen, and sets no timers.
  void medium_busy(SimTime /*now*/) override {}
  void medium_idle(SimTime /*now*/) override {}
  void reception_started(SimTime /*now*/) override {}
  void reception_failed(SimTime /*now*/) override {}
  void timer(SimTime /*now*/, MacTimer /*timer*/) override {}

 private:
  void send() {
    const Msdu& msdu = queue_.front();
    setting_.host->transmit(
        setting_.node, {.sender = setting_.node, .receiver = msdu.destination, .frame = msdu.frame},
        *setting_.parameters->group_mode, msdu.psdu_bytes);
  }

  MacSetting setting_;
  std::deque<Msdu> queue_;  ///< The front one is on the air.
};

constexpr MacMaker kAloha{.name = "aloha",
                          .make = [](const MacSetting& setting) -> std::unique_ptr<Mac> {
                            return std::make_unique<Aloha>(setting);
                          }};

TEST_CASE("a MAC of one's own is chosen by its name: pure ALOHA loses what theory has it lose") {
  struct Ignore final : AirListener {
    void delivered(const Delivery& /*delivery*/) override {}
    void finished(const FrameReport& /*report*/) override {}
  } listener;
  constexpr std::uint32_t kNodes = 40;
  constexpr double kFrames_per_s = 2'000.0;  // of all nodes
  AirParameters parameters;
  parameters.mac = "aloha";
  parameters.more_macs = {kAloha};
  parameters.nodes.assign(kNodes, AirNode{});
  FixedPositions positions{std::vector<Eigen::Vector3d>(kNodes, Eigen::Vector3d::Zero())};
  Air air{parameters, positions, listener};
  const random::CounterStream draws{7, 7};
  SimTime now{};
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const double gap_s = -std::log(1.0 - draws.uniform(2 * i)) / kFrames_per_s;
    now += Duration{std::llround(gap_s * 1e9)};
    air.offer(draws.below(2 * i + 1, kNodes), now, {.psdu_bytes = 128});
  }
  air.run_until(now + std::chrono::seconds{1});

  double received = 0.0;
  for (std::uint32_t node = 0; node < kNodes; ++node) {
    received += static_cast<double>(air.tally(node).received);
  }
  // N. Abramson, 1970: exp(-2 G), G being what the other nodes send in the 196 us of energy of a
  // frame. 128 B at 6 Mb/s take 202 us, 6 us of which are silent.
  const double others = kFrames_per_s * 196e-6 * (kNodes - 1) / kNodes;
  CHECK(received / (20'000.0 * (kNodes - 1)) == Approx(std::exp(-2.0 * others)).margin(0.02));
}

}  // namespace
}  // namespace cuscus::netsim
