#include "netsim/channel/walk.h"

#include <catch2/catch.hpp>
#include <vector>

namespace cuscus::netsim {
namespace {

std::vector<WalkPoint> points_of(const Walk& walk, const Channel& channel,
                                 const Antenna* antenna = nullptr) {
  std::vector<WalkPoint> points;
  along(walk, channel, antenna, [&](const WalkPoint& point) { points.push_back(point); });
  return points;
}

TEST_CASE("a walk visits its beginning, every step, and its end when a step comes to it") {
  const Channel channel{{.model = "friis"}};

  const auto whole =
      points_of({.p_WB = {10.0, 0.0, 0.0}, .p_WE = {11.0, 0.0, 0.0}, .step_m = 0.1}, channel);
  REQUIRE(whole.size() == 11);
  CHECK(whole.front().p_WM.x() == 10.0);
  CHECK(whole.back().p_WM.x() == Approx(11.0));
  CHECK(whole.back().way_m == Approx(1.0));

  const auto cut =
      points_of({.p_WB = {0.0, 0.0, 5.0}, .p_WE = {0.0, 0.0, 8.0}, .step_m = 2.0}, channel);
  REQUIRE(cut.size() == 2);
  CHECK(cut.back().distance_m == 7.0);

  CHECK(points_of({.p_WB = {1.0, 0.0, 0.0}, .p_WE = {1.0, 0.0, 0.0}}, channel).size() == 1);
}

TEST_CASE("the loss at a step is the sum of the channel's terms less the gains of the antennas") {
  const Channel channel{
      {.model = "log-distance",
       .exponent = 3.0,
       .shadowing_db = 6.0,
       .fading = "rice",
       .obstacles = {{.shape = {.centre_m = {50.0, 0.0}, .size_m = {10.0, 20.0, 15.0}}}}}};
  const HalfWaveDipole dipole;
  const Walk walk{.p_WF = {0.0, 0.0, 10.0}, .p_WB = {100.0, 0.0, 10.0}, .p_WE = {100.0, 9.0, 10.0}};

  const auto points = points_of(walk, channel, &dipole);

  REQUIRE(points.size() == 10);
  for (const WalkPoint& point : points) {
    const Link link = Link::between(0, walk.p_WF, 1, point.p_WM);
    CHECK(point.fixed.sum().value == channel.static_loss(link).value);
    CHECK(point.fixed.obstacles.sum().value > 10.0);  // behind walls of 12 dB each
    // Both dipoles are level: 2.15 dBi at either end (Balanis, 4.6).
    CHECK(point.antennas.value == Approx(4.3).margin(0.01));
    CHECK(point.loss().value ==
          Approx(point.fixed.sum().value + point.frame.fading.value - point.antennas.value));
  }
  CHECK(points[0].frame.fading.value != points[1].frame.fading.value);
}

TEST_CASE("a walk without steps, without speed or without end is refused") {
  const Channel channel{{.model = "friis"}};
  const Walk walk{.p_WE = {10.0, 0.0, 0.0}};
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Walk refused = walk;
    refused.step_m = bad;
    CHECK_THROWS_WITH(points_of(refused, channel), Catch::Contains("above 0"));
    refused = walk;
    refused.speed_mps = bad;
    CHECK_THROWS_WITH(points_of(refused, channel), Catch::Contains("above 0"));
  }
  Walk endless = walk;
  endless.p_WE.x() = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(points_of(endless, channel), Catch::Contains("finite"));
  endless = walk;
  endless.step_m = 1e-9;
  CHECK_THROWS_WITH(points_of(endless, channel), Catch::Contains("at most"));
}

}  // namespace
}  // namespace cuscus::netsim
