#include "netsim/channel/channel.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace cuscus::netsim {
namespace {

Decibel loss_at(const Channel& channel, double distance_m) {
  return channel.static_loss(Link::between(0, {0.0, 0.0, 10.0}, 1, {distance_m, 0.0, 10.0}));
}

TEST_CASE("log-distance with exponent 2 and no reference loss is free space") {
  const Channel friis{{.model = "friis", .carrier_hz = 2.437e9}};
  const Channel anchored{{.model = "log-distance", .carrier_hz = 2.437e9, .exponent = 2.0}};

  for (const double distance_m : {1.0, 10.0, 123.0, 1000.0}) {
    CHECK(loss_at(anchored, distance_m).value == Approx(loss_at(friis, distance_m).value));
  }
}

TEST_CASE("log-distance loses 10 n dB per decade from its reference loss at 1 m") {
  const Channel channel{
      {.model = "log-distance", .exponent = 3.5, .reference_loss = Decibel{46.7}}};

  CHECK(loss_at(channel, 1.0).value == Approx(46.7));
  CHECK(loss_at(channel, 100.0).value == Approx(46.7 + 70.0));
}

TEST_CASE("equation 1 of the paper is reproduced to the last bit") {
  const double alpha = GENERATE(20.0, 25.0, 30.0, 40.0);
  const double distance_m = GENERATE(10.0, 99.5, 410.0, 3000.0);
  const Channel channel{{.model = "paper-eq1", .carrier_hz = 2.437e9, .alpha = alpha}};

  const double expected_db =
      alpha * std::log10(distance_m / 1000.0) + alpha * std::log10(2.437e9 / 1e9) + 92.45;

  CHECK(loss_at(channel, distance_m).value == expected_db);
}

TEST_CASE("the curves of equation 1 meet where distance times frequency is 1 km GHz") {
  const Channel shallow{{.model = "paper-eq1", .carrier_hz = 2e9, .alpha = 20.0}};
  const Channel steep{{.model = "paper-eq1", .carrier_hz = 2e9, .alpha = 35.0}};

  CHECK(loss_at(shallow, 500.0).value == Approx(92.45));
  CHECK(loss_at(steep, 500.0).value == Approx(92.45));
  CHECK(loss_at(steep, 100.0) < loss_at(shallow, 100.0));
}

FrameOnLink frame_of(std::uint32_t sender, std::uint32_t receiver, std::uint64_t transmission) {
  return {.link = Link::between(sender, Eigen::Vector3d::Zero(), receiver, Eigen::Vector3d::Zero()),
          .from_low = sender < receiver,
          .transmission = transmission,
          .time = {}};
}

TEST_CASE(
    "Psi has mean 0 and variance chi, and is drawn per transmission and direction-free link") {
  const FrameVariation psi{7, 16.0};
  constexpr int kDraws = 20'000;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = psi.loss(frame_of(3, 9, i)).value;
    sum += x;
    squares += x * x;
  }

  // Standard errors: 4 / sqrt(n) = 0.028 for the mean, 16 sqrt(2/n) = 0.16 for the variance.
  CHECK(sum / kDraws == Approx(0.0).margin(0.12));
  CHECK(squares / kDraws == Approx(16.0).margin(0.7));
  CHECK(psi.loss(frame_of(3, 9, 5)) == psi.loss(frame_of(3, 9, 5)));
  CHECK(psi.loss(frame_of(3, 9, 5)) != psi.loss(frame_of(9, 3, 5)));
  CHECK(psi.loss(frame_of(3, 9, 5)) != psi.loss(frame_of(3, 8, 5)));
}

TEST_CASE("a wrong model or parameter is named, with what is allowed") {
  CHECK_THROWS_WITH((Channel{{.model = "frees"}}),
                    "propagation model 'frees' is not known; allowed are 'friis', 'log-distance', "
                    "'two-ray', 'paper-eq1', 'p1411', 'al-hourani', 'tr36777', 'fixed'");
  CHECK_THROWS_WITH((Channel{{.model = "log-distance", .exponent = 0.0}}),
                    "propagation model 'log-distance': exponent must be above 0");
  CHECK_THROWS_WITH((Channel{{.model = "paper-eq1", .chi_db2 = -1.0}}),
                    "propagation model 'paper-eq1': chi is a variance and must be at least 0 dB^2");
  CHECK_THROWS_WITH((Channel{{.fading = "rician"}}),
                    "fading model 'rician' is not known; allowed are 'none', 'rice', 'nakagami'");
  CHECK_THROWS_WITH((Channel{{.fading = "nakagami", .nakagami_m = 0.4}}),
                    "fading: m must be at least 0.5");
  CHECK_THROWS_WITH((Channel{{.shadowing_db = -1.0}}),
                    "shadowing: the standard deviation must be at least 0 dB");
}

}  // namespace
}  // namespace cuscus::netsim
