#include "netsim/air/air.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

SimTime at(std::int64_t us) { return SimTime{} + microseconds{us}; }

/// An air whose nodes stand on a line, and all that it says.
class Field final : public AirListener {
 public:
  explicit Field(const std::vector<double>& x_m, const AirParameters& parameters = {},
                 AirMonitor* monitor = nullptr)
      : positions_{on_x_axis(x_m)},
        air{with_nodes(parameters, x_m.size()), positions_, *this, monitor} {}

  void delivered(const Delivery& delivery) override { deliveries.push_back(delivery); }
  void finished(const FrameReport& report) override {
    reports.push_back(report);
    if (resend) {
      air.offer(report.sender, air.now(),
                {.destination = report.destination, .psdu_bytes = report.psdu_bytes});
    }
  }

 private:
  static std::vector<Eigen::Vector3d> on_x_axis(const std::vector<double>& x_m) {
    std::vector<Eigen::Vector3d> positions;
    positions.reserve(x_m.size());
    for (const double x : x_m) {
      positions.emplace_back(x, 0.0, 20.0);
    }
    return positions;
  }
  static AirParameters with_nodes(AirParameters parameters, std::size_t nodes) {
    parameters.nodes.assign(nodes, AirNode{});
    return parameters;
  }

  FixedPositions positions_;

 public:
  bool resend{false};
  std::vector<Delivery> deliveries;
  std::vector<FrameReport> reports;
  Air air;
};

TEST_CASE("a group frame arrives after DIFS, its airtime and the propagation delay") {
  Field field{{0.0, 30.0, 300.0}};

  field.air.offer(0, at(1000), {.id = 7, .psdu_bytes = 128});
  field.air.run_until(at(5000));

  // 202 us on the air; 300 m take 1000.7 ns.
  REQUIRE(field.deliveries.size() == 2);
  CHECK(field.deliveries[0].receiver == 1);
  CHECK(field.deliveries[0].time == at(1000 + 50 + 202) + std::chrono::nanoseconds{100});
  CHECK(field.deliveries[1].receiver == 2);
  CHECK(field.deliveries[1].time == at(1000 + 50 + 202) + std::chrono::nanoseconds{1001});
  CHECK(field.deliveries[1].id == 7);
  // 16.02 dBm - free space at 30 m and 2.412 GHz (69.64 dB).
  CHECK(field.deliveries[0].received_power.value == Approx(16.0206 - 69.64).margin(0.01));
  REQUIRE(field.reports.size() == 1);
  CHECK(field.reports[0].outcome == SendOutcome::kSent);
  CHECK(field.reports[0].deliveries == 2);
}

TEST_CASE("a ping on an idle air takes two DIFS, two frames and one ACK") {
  // 120 B of PSDU take 190 us at 6 Mb/s, the ACK 50 us, and 46 and 34 us at 54 Mb/s. At 15 m light
  // takes 50 ns each way: 540.1 and 236.1 us in all.
  struct Row {
    std::uint32_t rate_kbps;
    int round_trip_us;
  };
  const auto row = GENERATE(Row{6'000, 540}, Row{54'000, 236});
  Field field{{0.0, 15.0}, {.data_rate_kbps = row.rate_kbps}};

  field.air.offer(0, at(1000), {.destination = 1, .psdu_bytes = 120});
  while (field.deliveries.empty() && field.air.run_next(at(10'000))) {
  }
  REQUIRE(field.deliveries.size() == 1);
  field.air.offer(1, field.deliveries[0].time, {.destination = 0, .psdu_bytes = 120});
  field.air.run_until(at(10'000));

  REQUIRE(field.deliveries.size() == 2);
  CHECK(field.deliveries[1].time - at(1000) ==
        microseconds{row.round_trip_us} + std::chrono::nanoseconds{100});
}

TEST_CASE("a frame to an address that nobody has is tried seven times and dropped") {
  Field field{{0.0, 10.0}};

  field.air.offer(0, at(0), {.destination = kNobody, .psdu_bytes = 128});
  field.air.run_until(at(1'000'000));

  REQUIRE(field.reports.size() == 1);
  CHECK(field.reports[0].outcome == SendOutcome::kRetryLimit);
  CHECK(field.reports[0].attempts == 7);
  CHECK(field.air.tally(0).transmissions == 7);
  CHECK(field.air.tally(0).retries == 6);
  CHECK(field.deliveries.empty());
}

TEST_CASE("what is out of reach is lost as too weak, once per frame") {
  // -82 dBm is reached at 785 m, the arrival floor of -114 dBm at 31 km.
  const auto [distance_m, below_floor] =
      GENERATE(table<double, bool>({{2'000.0, false}, {100'000.0, true}}));
  Field field{{0.0, distance_m}};

  field.air.offer(0, at(0), {.psdu_bytes = 128});
  field.air.offer(0, at(0), {.destination = 1, .psdu_bytes = 128});
  field.air.run_until(at(1'000'000));

  // The group frame; the other, 7 tries.
  CHECK(field.air.tally(1).lost_below_floor == (below_floor ? 2 : 0));
  CHECK(field.air.tally(1).lost_below_detection == (below_floor ? 0 : 2));
  CHECK(field.air.tally(0).transmissions == 8);
  CHECK(field.air.tally(0).dropped_retry_limit == 1);
}

TEST_CASE("hidden stations whose frames fill every gap deliver nothing to the one between them") {
  // 600 m from the middle, 1200 m apart: beyond carrier sense. 1400 B last longer than DIFS and a
  // full contention window, so frames always overlap (beyond the first).
  Field field{{0.0, 600.0, 1200.0}};
  field.resend = true;

  for (const std::uint32_t node : {0U, 2U}) {
    field.air.offer(node, at(0), {.psdu_bytes = 1464});
    field.air.offer(node, at(0), {.psdu_bytes = 1464});
  }
  field.air.run_until(at(2'000'000));

  CHECK(field.air.tally(0).transmissions > 800);
  CHECK(field.air.tally(1).received == 0);
  // The first of two that overlap is spoilt, the second finds the receiver with the first.
  CHECK(field.air.tally(1).lost_interference > 0);
  CHECK(field.air.tally(1).lost_collision + field.air.tally(1).lost_interference >
        field.air.tally(0).transmissions + field.air.tally(2).transmissions - 3);
}

/// Saturates an air and leaves it to come to rest.
Tally total_of(Field& field, std::size_t nodes) {
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const std::int32_t other = static_cast<std::int32_t>((node + 1) % nodes);
    for (int i = 0; i < 40; ++i) {
      field.air.offer(node, at(std::int64_t{500} * i),
                      {.destination = i % 3 == 0 ? kGroup : other, .psdu_bytes = 300});
    }
  }
  field.air.run_until(SimTime{} + seconds{20});
  Tally total;
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const Tally& t = field.air.tally(node);
    total.offered += t.offered;
    total.sent += t.sent;
    total.acknowledged += t.acknowledged;
    total.received += t.received;
    total.dropped_queue_full += t.dropped_queue_full;
    total.dropped_lifetime += t.dropped_lifetime;
    total.dropped_retry_limit += t.dropped_retry_limit;
    total.lost_below_floor += t.lost_below_floor;
    total.lost_below_detection += t.lost_below_detection;
    total.lost_noise += t.lost_noise;
    total.lost_collision += t.lost_collision;
    total.lost_interference += t.lost_interference;
    total.lost_half_duplex += t.lost_half_duplex;
  }
  return total;
}

TEST_CASE("every offered frame has one outcome and every reception one cause") {
  // Spread so that some links are strong, some weak and some hidden; short queues and lifetimes.
  std::vector<double> x_m;
  x_m.reserve(12);
  for (int i = 0; i < 12; ++i) {
    x_m.push_back(170.0 * i);
  }
  AirParameters parameters;
  parameters.queue_frames = 20;
  parameters.queue_lifetime = milliseconds{100};
  Field field{x_m, parameters};

  const Tally t = total_of(field, x_m.size());

  CHECK(t.offered == std::uint64_t{12} * 40);
  CHECK(field.reports.size() == t.offered);
  CHECK(t.sent + t.acknowledged + t.dropped_queue_full + t.dropped_lifetime +
            t.dropped_retry_limit ==
        t.offered);
  // Group frames that went on the air have 11 receptions each; others one, if they went at all.
  std::uint64_t expected = 0;
  std::uint64_t delivered = 0;
  for (const FrameReport& report : field.reports) {
    delivered += report.deliveries;
    if (report.attempts > 0) {
      expected += report.destination == kGroup ? 11 : 1;
    }
  }
  CHECK(t.received == delivered);
  CHECK(t.received + t.lost_below_floor + t.lost_below_detection + t.lost_noise + t.lost_collision +
            t.lost_interference + t.lost_half_duplex ==
        expected);
  CHECK(t.lost_collision > 0);
  CHECK(t.lost_half_duplex > 0);
  CHECK(t.lost_below_detection > 0);
}

/// Two nodes, and the power at which a frame of one arrives at the other.
class Pair final : public AirListener {
 public:
  Pair(PositionSource& positions, const std::string& antenna)
      : air_{{.antenna = {.model = antenna}, .nodes = {AirNode{}, AirNode{}}}, positions, *this} {}

  void delivered(const Delivery& delivery) override { power_dbm_ = delivery.received_power.value; }
  void finished(const FrameReport& /*report*/) override {}
  /// Nothing when it does not arrive.
  std::optional<double> power_dbm(std::uint32_t sender = 0) {
    power_dbm_.reset();
    air_.offer(sender, air_.now(), {.psdu_bytes = 128});
    air_.run_until(air_.now() + milliseconds{10});
    return power_dbm_;
  }

 private:
  std::optional<double> power_dbm_;
  Air air_;
};

TEST_CASE("a UAV above another is out of the reach of its dipole, unless both roll") {
  const std::vector<Eigen::Vector3d> stacked{{0.0, 0.0, 20.0}, {0.0, 0.0, 80.0}};
  const std::vector<Eigen::Vector3d> abreast{{0.0, 0.0, 20.0}, {60.0, 0.0, 20.0}};
  const Eigen::Quaterniond rolled{Eigen::AngleAxisd{std::acos(0.0), Eigen::Vector3d::UnitX()}};
  FixedPositions level{stacked};
  FixedPositions on_their_sides{stacked, {rolled, rolled}};
  FixedPositions side_by_side{abreast};

  // 16.02 dBm less 75.66 dB of free space at 60 m; the nulls take 60 dB more, the belts give 4.30.
  CHECK(Pair{level, "isotropic"}.power_dbm().value() == Approx(-59.64).margin(0.01));
  CHECK_FALSE(Pair{level, "dipole"}.power_dbm());
  CHECK(Pair{on_their_sides, "dipole"}.power_dbm().value() == Approx(-55.34).margin(0.01));
  CHECK(Pair{side_by_side, "dipole"}.power_dbm().value() == Approx(-55.34).margin(0.01));
}

TEST_CASE("a link has one loss in both directions, however its ends are turned") {
  const Eigen::Quaterniond a{Eigen::AngleAxisd{0.4, Eigen::Vector3d::UnitX()}};
  const Eigen::Quaterniond b{Eigen::AngleAxisd{-1.1, Eigen::Vector3d::UnitY()}};
  FixedPositions positions{{{0.0, 0.0, 20.0}, {30.0, -14.0, 41.0}}, {a, b}};
  Pair pair{positions, "dipole"};

  CHECK(pair.power_dbm(0).value() == pair.power_dbm(1).value());
}

/// Share of 20'000 group frames of 202 us, one every 3.7 ms, that a neighbour loses as jammed.
double jammed_share(const DisruptionParameters& disruption) {
  Field field{{0.0, 10.0}, {.disruption = disruption}};
  constexpr int kFrames = 20'000;
  for (int i = 0; i < kFrames; ++i) {
    field.air.offer(0, at(std::int64_t{3'700} * i), {.psdu_bytes = 128});
    field.air.run_until(at(std::int64_t{3'700} * (i + 1)));
  }
  const Tally& t = field.air.tally(1);
  CHECK(t.received + t.lost_jammed == kFrames);
  return static_cast<double>(t.lost_jammed) / kFrames;
}

TEST_CASE("a disrupted network loses the fraction of its beacons, as jammed") {
  const auto phase = GENERATE(DisruptionPhase::kFixed, DisruptionPhase::kRandom);
  const double fraction = GENERATE(0.4, 0.7, 0.8);
  const DisruptionParameters disruption{
      .fraction = fraction, .interval = seconds{1}, .phase = phase};

  // A frame is lost when any of its 196 us before the signal extension is in the stretch. Four
  // standard deviations of 20'000 draws: 0.014; the 74 stretches are all whole.
  CHECK(jammed_share(disruption) == Approx(fraction + 196e-6).margin(0.014));
  CHECK(jammed_share(disruption) == jammed_share(disruption));
}

TEST_CASE("a frame out of reach is too weak in a disrupted network too") {
  Field field{{0.0, 2'000.0}, {.disruption = {.fraction = 1.0}}};

  field.air.offer(0, at(0), {.psdu_bytes = 128});
  field.air.run_until(at(10'000));

  CHECK(field.air.tally(1).lost_below_detection == 1);
  CHECK(field.air.tally(1).lost_jammed == 0);
}

TEST_CASE("an individually addressed frame is tried again until the stretch is over") {
  // Jammed for the first millisecond of every ten.
  Field field{{0.0, 10.0}, {.disruption = {.fraction = 0.1, .interval = milliseconds{10}}}};

  field.air.offer(0, at(0), {.destination = 1, .psdu_bytes = 128});
  field.air.run_until(at(50'000));

  REQUIRE(field.reports.size() == 1);
  CHECK(field.reports[0].outcome == SendOutcome::kAcknowledged);
  CHECK(field.reports[0].attempts > 1);
  CHECK(field.deliveries.at(0).time > at(1000));
}

TEST_CASE("equal inputs give equal runs, however the simulation is driven") {
  const std::vector<double> x_m{0.0, 50.0, 400.0, 700.0, 1100.0};
  Field once{x_m};
  Field again{x_m};
  Field other_seed{x_m, {.seed = 2}};
  for (Field* field : {&once, &again, &other_seed}) {
    for (std::uint32_t node = 0; node < x_m.size(); ++node) {
      for (int i = 0; i < 50; ++i) {
        field->air.offer(node, at(std::int64_t{900} * i + 13 * static_cast<std::int64_t>(node)),
                         {.psdu_bytes = 400});
      }
    }
  }

  once.air.run_until(at(200'000));
  for (std::int64_t us = 0; us <= 200'000; us += 7) {
    again.air.run_until(at(us));
  }
  again.air.run_until(at(200'000));
  other_seed.air.run_until(at(200'000));

  const auto same = [](const Field& a, const Field& b) {
    if (a.deliveries.size() != b.deliveries.size()) {
      return false;
    }
    for (std::size_t i = 0; i < a.deliveries.size(); ++i) {
      if (a.deliveries[i].time != b.deliveries[i].time ||
          a.deliveries[i].receiver != b.deliveries[i].receiver) {
        return false;
      }
    }
    return true;
  };
  CHECK(same(once, again));
  CHECK_FALSE(same(once, other_seed));
}

TEST_CASE("a frame offered late counts as sent now, and nothing runs before its time") {
  Field field{{0.0, 10.0}};
  field.air.run_until(at(5000));

  field.air.offer(0, at(4000), {.psdu_bytes = 128});
  CHECK(field.air.next_event() == at(5000));
  CHECK_FALSE(field.air.run_next(at(4999)));
  field.air.run_until(at(6000));

  REQUIRE(field.deliveries.size() == 1);
  CHECK(field.deliveries[0].time > at(5252));
}

TEST_CASE("the delivery bound is never later than the delivery") {
  Field field{{0.0, 100.0, 250.0}};
  field.resend = true;
  for (std::uint32_t node = 0; node < 3; ++node) {
    field.air.offer(node, at(std::int64_t{10} * static_cast<std::int64_t>(node)),
                    {.psdu_bytes = 200});
  }

  std::size_t checked = 0;
  while (checked < 500) {
    const auto bound = field.air.next_delivery_bound();
    REQUIRE(bound);
    const std::size_t before = field.deliveries.size();
    REQUIRE(field.air.run_next(at(10'000'000)));
    if (field.deliveries.size() > before) {
      CHECK(field.deliveries[before].time >= *bound);
      ++checked;
    }
  }
}

TEST_CASE("impossible radios are refused by name") {
  CHECK_THROWS_WITH((Field{{0.0, 1.0}, {.data_rate_kbps = 7'000}}),
                    Catch::Contains("no rate of 7000 kb/s"));
  CHECK_THROWS_WITH((Field{{0.0, 1.0}, {.retry_limit = 0}}), Catch::Contains("retry limit"));
  CHECK_THROWS_WITH((Field{{}}), Catch::Contains("1 to 65535 nodes"));
}

}  // namespace
}  // namespace cuscus::netsim
