// Saturated stations against analysis and an independent simulation of the standard's DCF.
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <limits>

#include "netsim/app/synthetic.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;

SyntheticParameters saturated(std::uint32_t rate_kbps, int slot_us, std::uint32_t senders) {
  SyntheticParameters p;
  p.air.data_rate_kbps = rate_kbps;
  p.air.group_rate_kbps = rate_kbps;
  p.air.slot = microseconds{slot_us};
  p.senders = senders;
  p.traffic = {.kind = Traffic::Kind::kSaturated, .group = false, .udp_payload_bytes = 1'472};
  p.duration = seconds{30};
  // Every collision is noticed as a frame that failed, so that those around wait EIFS.
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  p.air.detection_minimum = {kNone};
  p.air.detection_minimum_sinr = {kNone};
  return p;
}

/// Of IP packets of 1500 B: PSDUs of 1536 B.
double ip_goodput_mbps(const SyntheticParameters& p) {
  return run_synthetic(p).goodput_mbps * 1500.0 / 1472.0;
}

TEST_CASE("saturated stations share the air as theory has it") {
  // Seven attempts, EIFS of SIFS + 50 us + DIFS; means of 200 s of an independent simulation, which
  // keeps within 1 to 2.5 % of Bianchi's analysis with finite retries [G. Bianchi, IEEE J. Sel.
  // Areas Commun. 18(3), 2000].
  struct Row {
    std::uint32_t rate_kbps;
    int slot_us;
    std::array<double, 5> goodput_mbps;  // of 1, 2, 5, 10, 20 stations
  };
  const auto row = GENERATE(Row{6'000, 20, {5.133, 4.959, 4.569, 4.232, 3.864}},
                            Row{24'000, 20, {15.27, 15.55, 14.81, 13.85, 12.71}},
                            Row{54'000, 20, {24.11, 25.77, 25.35, 23.98, 22.17}},
                            Row{54'000, 9, {30.50, 30.86, 28.96, 27.01, 24.78}});
  constexpr std::array<std::uint32_t, 5> kStations{1, 2, 5, 10, 20};
  for (std::size_t i = 0; i < kStations.size(); ++i) {
    CAPTURE(row.rate_kbps, row.slot_us, kStations[i]);
    CHECK(ip_goodput_mbps(saturated(row.rate_kbps, row.slot_us, kStations[i])) ==
          Approx(row.goodput_mbps[i]).epsilon(0.02));
  }
}

TEST_CASE("saturated broadcasters lose what theory has them lose, more where nobody waits EIFS") {
  // 164 B at 6 Mb/s, slot 20 us; means of an independent simulation.
  const auto [stations, with_eifs, without_eifs] = GENERATE(table<std::uint32_t, double, double>(
      {{2, 0.881, 0.881}, {5, 0.615, 0.612}, {10, 0.368, 0.340}, {20, 0.193, 0.129}}));
  SyntheticParameters p = saturated(6'000, 20, stations);
  p.traffic.group = true;
  p.traffic.udp_payload_bytes = 100;
  CAPTURE(stations);
  CHECK(run_synthetic(p).delivery_ratio == Approx(with_eifs).margin(0.015));

  // With the usual detection equal frames that collide are no frames, and nobody waits EIFS.
  p.air.detection_minimum = AirParameters{}.detection_minimum;
  p.air.detection_minimum_sinr = AirParameters{}.detection_minimum_sinr;
  CHECK(run_synthetic(p).delivery_ratio == Approx(without_eifs).margin(0.015));
}

TEST_CASE("a single sender's goodput follows from the durations of one exchange") {
  // DIFS + 7.5 slots + data + SIFS + ACK [J. Jun, P. Peddabachagari, M. Sichitiu, NCA 2003].
  const auto [rate_kbps, slot_us, expected_mbps] =
      GENERATE(table<std::uint32_t, int, double>({{6'000, 20, 5.133},
                                                  {12'000, 20, 9.217},
                                                  {24'000, 20, 15.267},
                                                  {54'000, 20, 24.096},
                                                  {6'000, 9, 5.373},
                                                  {36'000, 9, 23.553},
                                                  {54'000, 9, 30.496}}));
  CAPTURE(rate_kbps, slot_us);
  CHECK(ip_goodput_mbps(saturated(rate_kbps, slot_us, 1)) == Approx(expected_mbps).epsilon(0.005));

  SyntheticParameters announced = saturated(54'000, slot_us, 1);
  announced.air.rts_threshold_bytes = 0;
  // With RTS, in UDP payload: 20.096 Mb/s at 20 us, 24.457 at 9 us; RTS and CTS at 24 Mb/s.
  CHECK(run_synthetic(announced).goodput_mbps ==
        Approx(slot_us == 20 ? 20.096 : 24.457).epsilon(0.005));
}

/// Two saturated senders of 1500 B of IP, each to a node of its own, at the best rate for what it
/// hears from there. All hear one another equally well but for what a faint node sends.
class TwoSenders final : public AirListener {
 public:
  enum class Receiver : bool { kLoud, kFaint };

  TwoSenders(Receiver first, Receiver second)
      : positions_{std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::Zero())},
        air_{parameters(first, second), positions_, *this} {}

  /// Frames delivered per second, of each.
  std::array<double, 2> run() {
    constexpr double kDuration_s = 20.0;
    for (const std::uint32_t sender : {0U, 1U}) {
      offer(sender);
      offer(sender);
    }
    air_.run_until(SimTime{} + seconds{20});
    return {static_cast<double>(delivered_[0]) / kDuration_s,
            static_cast<double>(delivered_[1]) / kDuration_s};
  }

  void delivered(const Delivery& delivery) override { ++delivered_.at(delivery.sender); }
  void finished(const FrameReport& report) override { offer(report.sender); }

 private:
  static AirParameters parameters(Receiver first, Receiver second) {
    AirParameters p;
    p.rate_control = "ideal";
    p.channel.model = "fixed";
    p.channel.reference_loss = {70.0};
    p.nodes.assign(4, AirNode{.tx_power = {20.0}});
    // -81 dBm at the others, 13 dB above the noise: enough for ACKs, not for fast rates.
    constexpr DecibelMilliwatt kFaint{-11.0};
    p.nodes[2].tx_power = first == Receiver::kFaint ? kFaint : p.nodes[2].tx_power;
    p.nodes[3].tx_power = second == Receiver::kFaint ? kFaint : p.nodes[3].tx_power;
    return p;
  }
  void offer(std::uint32_t sender) {
    air_.offer(sender, air_.now(),
               {.destination = static_cast<std::int32_t>(sender) + 2,
                .psdu_bytes = psdu_bytes_of_udp(1'472)});
  }

  FixedPositions positions_;
  Air air_;
  std::array<std::uint64_t, 2> delivered_{};
};

TEST_CASE("a slow sender slows the fast one down to its own pace") {
  // M. Heusse, F. Rousseau, G. Berger-Sabbatel, A. Duda, "Performance anomaly of 802.11b", INFOCOM
  // 2003: turns are equal, so that a cycle is one frame of each, and lasts as long as half of a
  // cycle of two fast senders and half of one of two slow ones. Collisions, which last as long as
  // the slower frame, are rare between two: 4 % are allowed.
  using enum TwoSenders::Receiver;
  const auto fast = TwoSenders{kLoud, kLoud}.run();
  const auto slow = TwoSenders{kFaint, kFaint}.run();
  const auto mixed = TwoSenders{kLoud, kFaint}.run();

  REQUIRE(fast[0] > 2.0 * slow[0]);
  CHECK(mixed[0] == Approx(mixed[1]).epsilon(0.04));
  const double expected = 1.0 / (0.5 / fast[0] + 0.5 / slow[0]);
  CHECK(mixed[0] == Approx(expected).epsilon(0.04));
  CHECK(mixed[1] == Approx(expected).epsilon(0.04));
}

TEST_CASE("saturated stations get equal shares in the long run") {
  // Shares of T seconds deviate as the square root of 1 / T, the index from 1 as 1 / T: sixteen
  // times as long, sixteen times nearer; means of ten runs are within a factor of three of that.
  const auto unfairness = [](int duration_s) {
    SyntheticParameters p = saturated(24'000, 20, 5);
    p.duration = seconds{duration_s};
    double sum = 0.0;
    for (p.air.seed = 1; p.air.seed <= 10; ++p.air.seed) {
      sum += 1.0 - run_synthetic(p).jain;
    }
    return sum / 10.0;
  };
  const double in_short = unfairness(1);
  const double in_long = unfairness(16);
  CAPTURE(in_short, in_long);
  CHECK(in_long < 0.005);
  CHECK(in_short / in_long > 16.0 / 3.0);
}

}  // namespace
}  // namespace cuscus::netsim
