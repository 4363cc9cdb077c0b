#include "uav-agent/missions/circle_law.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "uav-agent/missions/angle.h"

namespace cuscus::missions {
namespace {

const CircleParameters kCircle{.p_WC_centre_m = {0.0, 0.0, 10.0},
                               .radius_m = 20.0,
                               .speed_mps = 2.5,
                               .spacing_gain_ps = 0.5,
                               .speed_limit_ratio = 2.0};

/// Points that move at the speed of the law, each knowing its neighbours at once.
class Ring {
 public:
  explicit Ring(std::vector<double> angles_rad) : angles_rad_{std::move(angles_rad)} {}

  [[nodiscard]] std::uint32_t size() const {
    return static_cast<std::uint32_t>(angles_rad_.size());
  }
  [[nodiscard]] NeighbourAngles neighbours(std::uint32_t i) const {
    const auto n = size();
    return {.previous_rad = angles_rad_[(i + n - 1) % n], .next_rad = angles_rad_[(i + 1) % n]};
  }
  [[nodiscard]] std::vector<double> speeds_radps() const {
    std::vector<double> speeds;
    for (std::uint32_t i = 0; i < size(); ++i) {
      speeds.push_back(circle_law(angles_rad_[i], size(), neighbours(i), kCircle));
    }
    return speeds;
  }
  void run(double seconds, double step_s = 0.001) {
    for (double t = 0.0; t < seconds - step_s / 2; t += step_s) {
      const auto speeds = speeds_radps();
      for (std::uint32_t i = 0; i < size(); ++i) {
        angles_rad_[i] = wrapped(angles_rad_[i] + speeds[i] * step_s);
      }
    }
  }
  /// Deviation of each point from even spacing about their common phase.
  [[nodiscard]] std::vector<double> deviations_rad() const {
    double sine = 0.0;
    double cosine = 0.0;
    for (std::uint32_t i = 0; i < size(); ++i) {
      sine += std::sin(angles_rad_[i] - kTurn_rad * i / size());
      cosine += std::cos(angles_rad_[i] - kTurn_rad * i / size());
    }
    std::vector<double> result;
    for (std::uint32_t i = 0; i < size(); ++i) {
      result.push_back(wrapped(angles_rad_[i] - kTurn_rad * i / size() - std::atan2(sine, cosine)));
    }
    return result;
  }

 private:
  std::vector<double> angles_rad_;
};

Ring even_ring(std::uint32_t n, double phase_rad = 0.0) {
  std::vector<double> angles;
  for (std::uint32_t i = 0; i < n; ++i) {
    angles.push_back(wrapped(phase_rad + kTurn_rad * i / n));
  }
  return Ring{angles};
}

TEST_CASE("even spacing is a fixed point of the circle law, for any fleet and phase") {
  const auto n = GENERATE(1U, 2U, 3U, 10U, 50U);
  const auto phase_rad = GENERATE(0.0, 1.0, 3.1);

  for (const double speed : even_ring(n, phase_rad).speeds_radps()) {
    CHECK(speed == Approx(2.5 / 20.0));
  }
}

TEST_CASE("a disturbed ring returns to even spacing at the rate of the linearised law") {
  constexpr std::uint32_t kFleet = 10;
  constexpr double kAmplitude_rad = 0.01;
  const auto mode = GENERATE(1, 2, 3, 5);
  std::vector<double> angles;
  for (std::uint32_t i = 0; i < kFleet; ++i) {
    const double turn = kTurn_rad * i / kFleet;
    angles.push_back(wrapped(turn + kAmplitude_rad * std::cos(mode * turn)));
  }
  Ring ring{angles};
  constexpr double kTime_s = 4.0;

  ring.run(kTime_s);

  const double rate_ps = kCircle.spacing_gain_ps * (1.0 - std::cos(kTurn_rad * mode / kFleet));
  const double expected_rad = kAmplitude_rad * std::exp(-rate_ps * kTime_s);
  // One millisecond of explicit Euler at rates up to 1/s: below one part in a thousand per second.
  CHECK(ring.deviations_rad()[0] == Approx(expected_rad).epsilon(0.005));
}

TEST_CASE("a ring that is far from even converges") {
  Ring ring{{0.0, 0.3, 0.7, 1.9, 2.4, 2.9, 3.5 - kTurn_rad, 4.0 - kTurn_rad, 5.5 - kTurn_rad,
             6.0 - kTurn_rad}};

  ring.run(100.0, 0.01);

  for (const double deviation : ring.deviations_rad()) {
    CHECK(std::abs(deviation) < 1e-3);
  }
}

TEST_CASE("neighbours at equal distances leave the speed alone, whatever the distance") {
  const double distance_rad = GENERATE(0.1, 0.5, 1.0);

  const double speed = circle_law(
      3.0, 10, {.previous_rad = 3.0 - distance_rad, .next_rad = wrapped(3.0 + distance_rad)},
      kCircle);

  CHECK(speed == Approx(kCircle.nominal_radps()));
}

TEST_CASE("mirrored neighbours give mirrored corrections") {
  const double own = 0.7;
  const double error = spacing_error(own, 10, {.previous_rad = own - 0.5, .next_rad = own + 0.9});
  const double mirrored =
      spacing_error(own, 10, {.previous_rad = own - 0.9, .next_rad = own + 0.5});

  CHECK(error == Approx(0.2));  // the middle of the neighbours is 0.2 ahead
  CHECK(mirrored == Approx(-error));
}

TEST_CASE("one neighbour is enough, and none means nominal speed") {
  const double gap_rad = kTurn_rad / 10;

  CHECK(spacing_error(1.0, 10, {.previous_rad = 1.0 - gap_rad + 0.1, .next_rad = {}}) ==
        Approx(0.1));
  CHECK(spacing_error(1.0, 10, {.previous_rad = {}, .next_rad = 1.0 + gap_rad - 0.1}) ==
        Approx(-0.1));
  CHECK(circle_law(1.0, 10, {}, kCircle) == kCircle.nominal_radps());
}

TEST_CASE("the speed stays between standing and its limit") {
  const double gap_rad = kTurn_rad / 10;

  CHECK(circle_law(0.0, 10, {.previous_rad = -gap_rad - 3.0, .next_rad = {}}, kCircle) == 0.0);
  CHECK(circle_law(0.0, 10, {.previous_rad = {}, .next_rad = gap_rad + 3.0}, kCircle) ==
        Approx(2.0 * kCircle.nominal_radps()));
}

TEST_CASE("equally old positions slow the ring down and leave it even") {
  // All positions are as old as `age`: the common error is -w age, so w = w0 / (1 + k age).
  constexpr double kAge_s = 0.25;
  double speed = kCircle.nominal_radps();
  for (int i = 0; i < 50; ++i) {
    const double lag_rad = speed * kAge_s;
    const double gap_rad = kTurn_rad / 10;
    speed = circle_law(0.0, 10, {.previous_rad = -gap_rad - lag_rad, .next_rad = gap_rad - lag_rad},
                       kCircle);
  }

  CHECK(speed == Approx(kCircle.nominal_radps() / (1.0 + kCircle.spacing_gain_ps * kAge_s)));
}

class TableFixture {
 protected:
  void hear(std::uint32_t slot, double angle_rad, double radius_m = 20.0, double z_m = 10.0) {
    REQUIRE(table_.accept(
                {.slot = slot,
                 .sequence = 1,
                 .time = sim_time(1'000'000'000),
                 .p_WB_m = {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m}},
                now_) == NeighbourTable::Verdict::kAccepted);
  }

  SimTime now_ = sim_time(1'500'000'000);
  NeighbourTable table_{0, 10, std::chrono::seconds{3}};
};

TEST_CASE_METHOD(TableFixture,
                 "the neighbours of a slot are the ones before and after it on the ring") {
  hear(9, -0.6);
  hear(1, 0.7);
  hear(5, 3.0);

  const auto angles = neighbour_angles(table_, now_, kCircle);

  CHECK(angles.previous_rad.value() == Approx(-0.6));
  CHECK(angles.next_rad.value() == Approx(0.7));
}

TEST_CASE_METHOD(TableFixture, "a neighbour that is not on the circle is not kept distance to") {
  hear(9, -0.6, 20.0, 0.0);
  hear(1, 0.7, 5.0);

  const auto angles = neighbour_angles(table_, now_, kCircle);

  CHECK_FALSE(angles.previous_rad);
  CHECK_FALSE(angles.next_rad);
}

TEST_CASE_METHOD(TableFixture, "what lies on the ground is not on a low circle either") {
  CircleParameters low = kCircle;
  low.p_WC_centre_m.z() = GENERATE(0.5, 2.0, 5.0);
  hear(9, -0.6, 20.0, 0.05);
  hear(1, 0.7, 20.0, 0.9 * low.p_WC_centre_m.z());

  const auto angles = neighbour_angles(table_, now_, low);

  CHECK_FALSE(angles.previous_rad);
  CHECK(angles.next_rad);
}

TEST_CASE_METHOD(TableFixture,
                 "positions are taken as last heard unless extrapolation is asked for") {
  hear(1, 0.7);
  CircleParameters extrapolating = kCircle;
  extrapolating.extrapolate = true;

  CHECK(neighbour_angles(table_, now_, kCircle).next_rad.value() == Approx(0.7));
  // 0.5 s old at 0.125 rad/s.
  CHECK(neighbour_angles(table_, now_, extrapolating).next_rad.value() == Approx(0.7625));
}

}  // namespace
}  // namespace cuscus::missions
