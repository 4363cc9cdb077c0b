#include "netsim/air/jamming.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "netsim/air/air.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

SimTime after(Duration duration) { return SimTime{} + duration; }

/// Two nodes 400 m apart (-76.2 dBm from one to the other in free space), and jammers.
class JammedPair final : public AirListener {
 public:
  explicit JammedPair(const AirParameters& parameters)
      : positions_{{{0.0, 0.0, 20.0}, {400.0, 0.0, 20.0}}},
        air{with_nodes(parameters), positions_, *this} {}

  void delivered(const Delivery& delivery) override { deliveries.push_back(delivery); }
  void finished(const FrameReport& report) override { reports.push_back(report); }

  /// Frames of 128 B (202 us at 6 Mb/s), which node 0 sends on an idle air.
  void send(int frames, Duration period) {
    for (int i = 0; i < frames; ++i) {
      air.offer(0, after(i * period), {.id = static_cast<std::uint64_t>(i), .psdu_bytes = 128});
    }
    air.run_until(after(frames * period + seconds{1}));
  }

 private:
  static AirParameters with_nodes(AirParameters parameters) {
    parameters.nodes.assign(2, AirNode{});
    return parameters;
  }

  FixedPositions positions_;

 public:
  std::vector<Delivery> deliveries;
  std::vector<FrameReport> reports;
  Air air;
};

/// A jammer in the middle: 6.02 dB nearer to either node than they are to each other.
JammerParameters jammer(double power_dbm) {
  return {.p_WJ = {200.0, 0.0, 20.0},
          .power = {power_dbm},
          .band = {.centre_hz = 2.412e9, .width_hz = 20e6}};
}

TEST_CASE("a jammer without breaks is a higher noise floor, frame for frame") {
  AirParameters jammed{.data_rate_kbps = 6'000};
  // SINR = 16.0206 + X dB, X = -6.02 - power. At 5.2 dBm it is near 4.8 dB, where frames of 128 B
  // are lost now and then.
  const double power_dbm = 16.0206 - 6.0206 - 4.8;
  jammed.detection_minimum_sinr = {-10.0};
  AirParameters noisy = jammed;
  jammed.jammers = {jammer(power_dbm)};
  const double noise_mw = noise_floor(20e6, jammed.noise_figure).milliwatts();
  const Channel channel{jammed.channel};
  const DecibelMilliwatt at_node =
      DecibelMilliwatt{power_dbm} -
      channel.static_loss(Link::between(0, {0.0, 0.0, 20.0}, 2, {200.0, 0.0, 20.0}));
  noisy.noise_figure =
      noisy.noise_figure + Decibel::from_ratio((noise_mw + at_node.milliwatts()) / noise_mw);

  JammedPair with_jammer{jammed};
  JammedPair with_noise{noisy};
  with_jammer.send(4'000, milliseconds{1});
  with_noise.send(4'000, milliseconds{1});

  REQUIRE(with_jammer.deliveries.size() == with_noise.deliveries.size());
  for (std::size_t i = 0; i < with_jammer.deliveries.size(); ++i) {
    REQUIRE(with_jammer.deliveries[i].id == with_noise.deliveries[i].id);
  }
  CHECK(with_jammer.deliveries.size() < 4'000);
  CHECK(with_jammer.air.tally(1).lost_jammed == 4'000 - with_jammer.deliveries.size());
  CHECK(with_noise.air.tally(1).lost_noise == with_jammer.air.tally(1).lost_jammed);
}

TEST_CASE("frames under a jammer fail as often as NIST's error rate at that SINR says") {
  AirParameters parameters{};
  parameters.detection_minimum_sinr = {-10.0};
  const double power_dbm = GENERATE(6.7, 7.1);
  parameters.jammers = {jammer(power_dbm)};
  JammedPair pair{parameters};

  constexpr int kFrames = 6'000;
  pair.send(kFrames, milliseconds{1});

  const Channel channel{parameters.channel};
  const auto received_mw = [&channel](double sent_dbm, double distance_m) {
    return (DecibelMilliwatt{sent_dbm} -
            channel.static_loss(Link::between(0, {0.0, 0.0, 20.0}, 1, {distance_m, 0.0, 20.0})))
        .milliwatts();
  };
  const double sinr = received_mw(16.0206, 400.0) /
                      (noise_floor(20e6, {7.0}).milliwatts() + received_mw(power_dbm, 200.0));
  const NistErrorModel nist;
  const double bit_failure = nist.bit_failure(Modulation::kBpsk, CodeRate::kHalf, sinr);
  // 24 bits of SIGNAL; 44 symbols of 4 us at 6 Mb/s after it (16 + 8 * 128 + 6 = 1046 bits).
  const double expected =
      std::exp(log_success(bit_failure, 24.0) + log_success(bit_failure, 44.0 * 24.0));
  CHECK(expected > 0.1);
  CHECK(expected < 0.95);
  // Four standard errors of a binomial share.
  const double share = static_cast<double>(pair.deliveries.size()) / kFrames;
  CHECK(share == Approx(expected).margin(4.0 * std::sqrt(expected * (1.0 - expected) / kFrames)));
}

TEST_CASE("pulses cost the frames that they meet") {
  // 12 dB above the frames, below the energy threshold of -62 dBm at either node. Pulses of 5 ms
  // every 10 ms; a frame is on the air for 196 us and begins DIFS (50 us) after its offer.
  AirParameters parameters{};
  JammerParameters pulses = jammer(16.0206 + 6.0);
  pulses.duty = 0.5;
  pulses.period = milliseconds{10};
  parameters.jammers = {pulses};
  JammedPair pair{parameters};

  // Each 10.01 ms on: 1000 evenly spaced phases of the pulses.
  pair.send(1'000, microseconds{10'010});

  // Met: 5 ms + 196 us of 10 ms. A pulse that takes less than one symbol of a frame (4 us), or only
  // part of its preamble (16 us), may spare it: 2 frames of 1000.
  const double lost = 1'000.0 - static_cast<double>(pair.deliveries.size());
  CHECK(lost == Approx(519.6).margin(3.0));
  CHECK(pair.air.tally(1).lost_jammed == static_cast<std::uint64_t>(lost));
}

TEST_CASE("a jammer above the energy threshold keeps the medium busy while it is on") {
  AirParameters parameters{};
  JammerParameters pulse = jammer(30.0);  // 200 m: -56 dBm
  pulse.start = milliseconds{10};
  pulse.stop = milliseconds{30};
  parameters.jammers = {pulse};
  JammedPair pair{parameters};

  pair.air.offer(0, after(milliseconds{12}), {.psdu_bytes = 128});
  pair.air.run_until(after(milliseconds{100}));

  // The medium is idle from 30 ms on: DIFS, at most 15 slots of backoff, 202 us and 1.3 us of way.
  REQUIRE(pair.deliveries.size() == 1);
  CHECK(pair.deliveries[0].time >= after(milliseconds{30} + microseconds{50 + 202}));
  CHECK(pair.deliveries[0].time <= after(milliseconds{30} + microseconds{50 + 300 + 204}));
}

TEST_CASE("a wall shields from a jammer") {
  AirParameters parameters{};
  parameters.jammers = {jammer(20.0)};
  JammedPair open{parameters};
  // Beside the way between the nodes, around the jammer.
  parameters.channel.obstacles = {
      {.shape = {.centre_m = {200.0, 0.0}, .size_m = {4.0, 4.0, 10.0}}, .outer_wall = {60.0}}};
  parameters.jammers[0].p_WJ.z() = 5.0;
  JammedPair shielded{parameters};

  open.send(20, milliseconds{2});
  shielded.send(20, milliseconds{2});

  CHECK(open.deliveries.empty());
  CHECK(shielded.deliveries.size() == 20);
}

TEST_CASE("a jammer beside the channel changes nothing") {
  AirParameters parameters{};
  JammerParameters beside = jammer(40.0);
  beside.band.centre_hz = 2.462e9;
  parameters.jammers = {beside};
  JammedPair pair{parameters};

  pair.send(20, milliseconds{2});

  CHECK(pair.deliveries.size() == 20);
}

TEST_CASE("a jammer's links have the loss, shadows and gains of links to a node after the last") {
  const ChannelParameters parameters{.carrier_hz = 2.437e9, .shadowing_db = 6.0};
  const Channel channel{parameters};
  const std::vector<Eigen::Vector3d> p_WN{{0.0, 0.0, 10.0}, {50.0, 80.0, 12.0}};
  const JammerParameters source{.p_WJ = {30.0, -40.0, 2.0}, .power = {25.0}};
  Jamming jamming{{source, source}, Band{}, channel, nullptr, {{0.0}, {3.0}}};

  const auto received_mw = jamming.received_mw(SimTime{}, {.p_WN = p_WN, .q_WN = {}, .version = 1});

  for (std::uint32_t node = 0; node < 2; ++node) {
    double expected_mw = 0.0;
    for (const std::uint32_t number : {2U, 3U}) {
      expected_mw += (source.power + Decibel{node == 1 ? 3.0 : 0.0} -
                      channel.static_loss(Link::between(number, source.p_WJ, node, p_WN[node])))
                         .milliwatts();
    }
    CHECK(received_mw[node] == Approx(expected_mw).epsilon(1e-12));
  }
}

TEST_CASE("what a jammer costs a node follows that node within 10 ms") {
  const Channel channel{{}};
  const JammerParameters source{.duty = 1.0};
  Jamming jamming{
      {source}, Band{.centre_hz = 2.437e9, .width_hz = 20e6}, channel, nullptr, {{0.0}}};
  std::vector<Eigen::Vector3d> p_WN{{100.0, 0.0, 0.0}};

  const double near_mw =
      jamming.received_mw(SimTime{}, {.p_WN = p_WN, .q_WN = {}, .version = 1})[0];
  const auto next = jamming.next_change(after(microseconds{7}));
  p_WN[0].x() = 200.0;
  const double far_mw = jamming.received_mw(*next, {.p_WN = p_WN, .q_WN = {}, .version = 2})[0];

  CHECK(next == after(milliseconds{10}));
  CHECK(near_mw / far_mw == Approx(4.0));  // free space
}

}  // namespace
}  // namespace cuscus::netsim
