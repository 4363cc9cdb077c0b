#include "netsim/air/ideal_air.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace cuscus::netsim {
namespace {

// 100 B of Ethernet at 6 Mb/s.
constexpr std::uint32_t kEthernet_bytes = 100;
constexpr Duration kSending{133'334};  // 800 bit / 6 Mb/s, rounded up

OfferedFrame ideal_frame(std::uint64_t id, std::int32_t destination = kGroup) {
  return {
      .id = id, .destination = destination, .psdu_bytes = psdu_bytes_of_ethernet(kEthernet_bytes)};
}

AirParameters ideal_parameters() {
  AirParameters p;
  p.mac = "ideal";
  p.ideal.delay = std::chrono::milliseconds{1};
  return p;
}

SimTime ideal_at(Duration time) { return SimTime{} + time; }

/// Three nodes at 0, 100 and 300 m, and all that their air says.
class IdealField final : public AirListener {
 public:
  explicit IdealField(AirParameters parameters = ideal_parameters(), AirMonitor* monitor = nullptr)
      : positions_{{{0.0, 0.0, 5.0}, {100.0, 0.0, 5.0}, {300.0, 0.0, 5.0}}},
        air{make_air(with_nodes(std::move(parameters)), positions_, *this, monitor)} {}

  void delivered(const Delivery& delivery) override { deliveries.push_back(delivery); }
  void finished(const FrameReport& report) override { reports.push_back(report); }

 private:
  static AirParameters with_nodes(AirParameters parameters) {
    parameters.nodes.assign(3, AirNode{});
    return parameters;
  }

  FixedPositions positions_;

 public:
  std::vector<Delivery> deliveries;
  std::vector<FrameReport> reports;
  std::unique_ptr<FrameCarrier> air;
};

TEST_CASE("an ideal air delivers after the sending and the delay, one frame of a node at a time") {
  IdealField field;
  field.air->offer(0, ideal_at(std::chrono::milliseconds{1}), ideal_frame(1));
  field.air->offer(0, ideal_at(std::chrono::milliseconds{1}), ideal_frame(2, 2));
  field.air->offer(1, ideal_at(std::chrono::milliseconds{1}), ideal_frame(3, 0));
  field.air->run_until(ideal_at(std::chrono::milliseconds{10}));

  const SimTime first = ideal_at(std::chrono::milliseconds{2}) + kSending;
  REQUIRE(field.deliveries.size() == 4);
  for (const Delivery& delivery : field.deliveries) {
    // Both nodes send at once, and node 0 receives while it sends.
    CHECK(delivery.time == (delivery.id == 2 ? first + kSending : first));
  }
  REQUIRE(field.reports.size() == 3);
  for (const FrameReport& report : field.reports) {
    CHECK(report.outcome == SendOutcome::kSent);
    CHECK(report.attempts == 1);
    CHECK(report.deliveries == (report.id == 1 ? 2 : 1));
  }
  CHECK(field.air->tally(0).sent == 2);
  CHECK(field.air->tally(2).received == 2);
}

TEST_CASE("beyond its range an ideal air delivers nothing") {
  AirParameters parameters = ideal_parameters();
  parameters.ideal.range_m = 250.0;
  IdealField field{parameters};
  field.air->offer(0, SimTime{}, ideal_frame(1));
  field.air->offer(0, SimTime{}, ideal_frame(2, 2));
  field.air->run_until(ideal_at(std::chrono::seconds{1}));

  REQUIRE(field.deliveries.size() == 1);
  CHECK(field.deliveries[0].receiver == 1);
  CHECK(field.air->tally(2).lost_below_floor == 2);
  CHECK(field.reports.size() == 2);
}

TEST_CASE("loss and jitter of an ideal air are drawn for each frame and receiver, by the seed") {
  const auto run = [](std::uint64_t seed) {
    AirParameters parameters = ideal_parameters();
    parameters.seed = seed;
    parameters.ideal.loss = 0.3;
    parameters.ideal.jitter = std::chrono::microseconds{500};
    parameters.queue_frames = 5'000;
    parameters.queue_lifetime = std::chrono::seconds{10};
    IdealField field{parameters};
    for (std::uint64_t id = 0; id < 4'000; ++id) {
      field.air->offer(0, SimTime{}, ideal_frame(id));
    }
    field.air->run_until(ideal_at(std::chrono::seconds{10}));
    CHECK(field.air->tally(1).received + field.air->tally(1).lost_noise == 4'000);
    return field.deliveries;
  };
  const auto deliveries = run(1);

  // Of 8000 draws with probability 0.7 the standard deviation is 0.005 of their number: 4 of them.
  CHECK(static_cast<double>(deliveries.size()) / 8'000.0 == Approx(0.7).margin(0.02));
  double least_us = 1e9;
  double most_us = 0.0;
  double sum_us = 0.0;
  std::set<std::uint64_t> at_both;
  std::uint64_t pairs = 0;
  for (const Delivery& delivery : deliveries) {
    const double delay_us = to_seconds(delivery.time - SimTime{} -
                                       kSending * static_cast<Duration::rep>(delivery.id + 1)) *
                            1e6;
    least_us = std::min(least_us, delay_us);
    most_us = std::max(most_us, delay_us);
    sum_us += delay_us;
    pairs += at_both.insert(delivery.id).second ? 0U : 1U;
  }
  // Uniform in 500 ... 1500 us; the mean of 5600 has a standard deviation of 3.9 us.
  CHECK(least_us >= 500.0);
  CHECK(least_us < 505.0);
  CHECK(most_us <= 1'500.0);
  CHECK(most_us > 1'495.0);
  CHECK(sum_us / static_cast<double>(deliveries.size()) == Approx(1'000.0).margin(16.0));
  // Receivers lose independently: both get 0.49 of the frames.
  CHECK(static_cast<double>(pairs) / 4'000.0 == Approx(0.49).margin(0.035));

  const auto again = run(1);
  const auto other = run(2);
  REQUIRE(again.size() == deliveries.size());
  CHECK(
      std::equal(again.begin(), again.end(), deliveries.begin(), [](const auto& a, const auto& b) {
        return a.time == b.time && a.id == b.id && a.receiver == b.receiver;
      }));
  CHECK(other.front().time != deliveries.front().time);
}

TEST_CASE("the queue of an ideal air is bounded, and what waits too long is dropped") {
  AirParameters parameters = ideal_parameters();
  parameters.queue_frames = 3;
  parameters.queue_lifetime = std::chrono::microseconds{200};
  IdealField field{parameters};
  for (std::uint64_t id = 0; id < 4; ++id) {
    field.air->offer(0, SimTime{}, ideal_frame(id));
  }
  field.air->run_until(ideal_at(std::chrono::seconds{1}));

  // The third would begin after 267 us.
  CHECK(field.air->tally(0).offered == 4);
  CHECK(field.air->tally(0).sent == 2);
  CHECK(field.air->tally(0).dropped_queue_full == 1);
  CHECK(field.air->tally(0).dropped_lifetime == 1);
  CHECK(field.reports.size() == 4);
}

struct RangeWatch final : public AirMonitor {
  void transmitted(const Ppdu& /*ppdu*/) override { ++ppdus; }
  void received(const Ppdu& /*ppdu*/, const Reception& reception) override {
    reached.insert(reception.receiver);
  }
  void unreached(const Ppdu& /*ppdu*/, std::uint32_t receiver) override { missed.insert(receiver); }

  int ppdus{0};
  std::set<std::uint32_t> reached;
  std::set<std::uint32_t> missed;
};

TEST_CASE("who is out of the range of an ideal air is told to its monitor, and is the cause") {
  AirParameters parameters = ideal_parameters();
  parameters.ideal.range_m = 150.0;
  RangeWatch watch;
  IdealField field{parameters, &watch};

  field.air->offer(0, SimTime{}, ideal_frame(1));
  field.air->offer(0, SimTime{}, ideal_frame(2, 2));
  field.air->run_until(ideal_at(std::chrono::seconds{1}));

  CHECK(watch.ppdus == 2);
  CHECK(watch.reached == std::set<std::uint32_t>{1});
  CHECK(watch.missed == std::set<std::uint32_t>{2});
  REQUIRE(field.reports.size() == 2);
  const FrameReport& to_far = field.reports[0].id == 2 ? field.reports[0] : field.reports[1];
  CHECK(to_far.last_loss == LossCause::kBelowFloor);
}

TEST_CASE("nothing comes before the bound that an ideal air gives") {
  IdealField field;
  field.air->offer(0, SimTime{}, ideal_frame(1));
  field.air->offer(1, ideal_at(std::chrono::microseconds{300}), ideal_frame(2));
  std::size_t seen = 0;
  while (const auto bound = field.air->next_delivery_bound()) {
    REQUIRE(field.air->run_next(SimTime::max()));
    for (; seen < field.deliveries.size(); ++seen) {
      CHECK(field.deliveries[seen].time >= *bound);
    }
  }
  CHECK(seen == 4);
}

TEST_CASE("an ideal air that cannot be is refused with what is allowed") {
  const auto error_of = [](const auto& change) {
    AirParameters parameters = ideal_parameters();
    change(parameters);
    try {
      IdealField field{parameters};
    } catch (const std::invalid_argument& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };

  CHECK_THAT(error_of([](AirParameters& p) { p.ideal.jitter = p.ideal.delay + Duration{1}; }),
             Catch::Contains("must be 0 ... its delay"));
  CHECK_THAT(error_of([](AirParameters& p) { p.ideal.loss = 1.5; }), Catch::Contains("0 ... 1"));
  CHECK_THAT(error_of([](AirParameters& p) { p.ideal.range_m = 0.0; }),
             Catch::Contains("above 0 m"));
}

}  // namespace
}  // namespace cuscus::netsim
