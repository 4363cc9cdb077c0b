#include "uav-agent/flight/estimator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "common/random/counter_stream.h"

namespace cuscus::flight {
namespace {

constexpr double kGravity = 9.81;
constexpr double kPositionNoise_m = 0.001;
constexpr double kAttitudeNoise_rad = 0.001;

/// A body on a circle in the plane, nose along its path: everything is known in closed form.
class Carousel {
 public:
  struct Truth {
    Eigen::Vector3d p_m, v_mps, force_B_mps2, rate_B_radps;
    Eigen::Quaterniond q;
  };

  [[nodiscard]] static Truth at(double t_s) {
    constexpr double kRadius_m = 5.0;
    constexpr double kRate_radps = 0.5;
    const double angle = kRate_radps * t_s;
    const Eigen::Vector3d out{std::cos(angle), std::sin(angle), 0.0};
    const Eigen::Vector3d along{-std::sin(angle), std::cos(angle), 0.0};
    // Body x is `along`, body y points to the centre: the acceleration is along +y.
    return {.p_m = kRadius_m * out + Eigen::Vector3d{0.0, 0.0, 10.0},
            .v_mps = kRadius_m * kRate_radps * along,
            .force_B_mps2 = {0.0, kRadius_m * kRate_radps * kRate_radps, kGravity},
            .rate_B_radps = {0.0, 0.0, kRate_radps},
            .q = Eigen::Quaterniond{
                Eigen::AngleAxisd{angle + std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()}}};
  }
};

/// Feeds an estimator from a Carousel: IMU every 5 ms, motion capture every 10 ms.
class Bench {
 public:
  Estimator estimator{EstimatorParameters{.gravity_mps2 = kGravity}};
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  bool imu_on = true;
  bool capture_on = true;

  [[nodiscard]] double now_s() const { return 0.005 * static_cast<double>(tick_); }
  [[nodiscard]] Carousel::Truth truth() const { return Carousel::at(now_s()); }

  void skip(double seconds) { tick_ += static_cast<std::uint64_t>(seconds / 0.005); }

  void run(double seconds, const std::function<void()>& observe = {}) {
    const double end_s = now_s() + seconds;
    while (now_s() < end_s - 1e-9) {
      ++tick_;
      const SimTime now = sim_time(static_cast<std::int64_t>(tick_) * 5'000'000);
      if (imu_on) {
        estimator.update(ImuReading{
            .time = now,
            .sequence = tick_,
            .angular_rate_B_radps = truth().rate_B_radps + gyro_bias_radps + noise(0.005),
            .specific_force_B_mps2 = truth().force_B_mps2 + noise(0.05)});
      }
      if (capture_on && tick_ % 2 == 0) {
        const Eigen::Vector3d turn = noise(kAttitudeNoise_rad);
        const Eigen::Quaterniond error{Eigen::AngleAxisd{turn.norm(), turn.normalized()}};
        estimator.update(MotionCaptureReading{.time = now,
                                              .sequence = tick_,
                                              .p_WB_m = truth().p_m + noise(kPositionNoise_m),
                                              .q_WB = truth().q * error});
      }
      if (observe) {
        observe();
      }
    }
  }

 private:
  Eigen::Vector3d noise(double deviation) {
    const double x = stream_.normal(draws_++);
    const double y = stream_.normal(draws_++);
    const double z = stream_.normal(draws_++);
    return deviation * Eigen::Vector3d{x, y, z};
  }

  random::CounterStream stream_{7, 1};
  std::uint64_t draws_ = 0;
  std::uint64_t tick_ = 0;
};

TEST_CASE("an estimator follows a moving body within the noise of its sensors") {
  Bench bench;
  bench.run(2.0);

  double position_m2 = 0.0;
  double velocity_mps2 = 0.0;
  double attitude_rad2 = 0.0;
  int count = 0;
  bench.run(10.0, [&] {
    const auto& e = bench.estimator.estimate();
    position_m2 += (e.p_WB_m - bench.truth().p_m).squaredNorm() / 3.0;
    velocity_mps2 += (e.v_WB_mps - bench.truth().v_mps).squaredNorm() / 3.0;
    attitude_rad2 += std::pow(e.q_WB.angularDistance(bench.truth().q), 2);
    ++count;
  });

  // Filtering must not be worse than the position reading itself. A velocity from the difference of
  // two readings would have sqrt(2) 1 mm / 10 ms = 0.14 m/s.
  CHECK(std::sqrt(position_m2 / count) < kPositionNoise_m);
  CHECK(std::sqrt(velocity_mps2 / count) < 0.02);
  // Three axes of 1 mrad, averaged over more than ten readings.
  CHECK(std::sqrt(attitude_rad2 / count) < kAttitudeNoise_rad);
}

TEST_CASE("an estimator finds a velocity that it did not start with") {
  Bench bench;
  bench.run(0.2);

  CHECK((bench.estimator.estimate().v_WB_mps - bench.truth().v_mps).norm() < 0.1);
}

TEST_CASE("an estimator learns a gyroscope's bias") {
  Bench bench;
  bench.gyro_bias_radps = {0.02, -0.01, 0.03};
  bench.run(30.0);

  Eigen::Vector3d mean_radps = Eigen::Vector3d::Zero();
  int count = 0;
  bench.run(5.0, [&] {
    mean_radps += bench.estimator.estimate().angular_rate_B_radps - bench.truth().rate_B_radps;
    ++count;
  });

  CHECK((mean_radps / count).norm() < 0.002);
}

TEST_CASE("without motion capture the IMU carries the estimate for a second") {
  Bench bench;
  bench.run(5.0);

  bench.capture_on = false;
  bench.run(1.0);

  CHECK((bench.estimator.estimate().p_WB_m - bench.truth().p_m).norm() < 0.1);
  CHECK((bench.estimator.estimate().v_WB_mps - bench.truth().v_mps).norm() < 0.1);
}

TEST_CASE("without an IMU the angular rate comes from motion capture") {
  Bench bench;
  bench.run(2.0);

  bench.imu_on = false;
  bench.run(1.0);
  double rate_radps = 0.0;
  bench.run(1.0, [&] { rate_radps += bench.estimator.estimate().angular_rate_B_radps.z() / 200; });

  // The mean of 100 differences of 1 mrad over 10 ms telescopes to 1.4 mrad/s.
  CHECK(rate_radps == Approx(0.5).margin(0.01));
  // The acceleration of 1.25 m/s^2 is not seen any more, only corrected for.
  CHECK((bench.estimator.estimate().p_WB_m - bench.truth().p_m).norm() < 0.05);
}

TEST_CASE("after a pause of the process the estimate is right again within 100 ms") {
  Bench bench;
  bench.run(2.0);

  bench.skip(2.0);
  bench.run(0.1);

  CHECK((bench.estimator.estimate().p_WB_m - bench.truth().p_m).norm() < 0.01);
  CHECK((bench.estimator.estimate().v_WB_mps - bench.truth().v_mps).norm() < 0.1);
  CHECK(bench.estimator.estimate().q_WB.angularDistance(bench.truth().q) < 0.01);
}

TEST_CASE("an estimator refuses numbers that are not finite and ignores old readings") {
  using Intake = Estimator::Intake;
  Bench bench;
  bench.run(1.0);
  const VehicleEstimate before = bench.estimator.estimate();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();

  CHECK(bench.estimator.update(
            ImuReading{.time = sim_time(2'000'000'000), .angular_rate_B_radps = {nan, 0.0, 0.0}}) ==
        Intake::kNotFinite);
  CHECK(bench.estimator.update(ImuReading{.time = sim_time(2'000'000'000),
                                          .specific_force_B_mps2 = {0.0, infinity, 0.0}}) ==
        Intake::kNotFinite);
  CHECK(bench.estimator.update(MotionCaptureReading{
            .time = sim_time(2'000'000'000), .p_WB_m = {0.0, 0.0, nan}}) == Intake::kNotFinite);
  CHECK(bench.estimator.update(MotionCaptureReading{
            .time = sim_time(2'000'000'000), .q_WB = {0.0, 0.0, 0.0, 0.0}}) == Intake::kNotFinite);
  CHECK(bench.estimator.update(ImuReading{.time = sim_time(500'000'000)}) == Intake::kRepeated);
  CHECK(bench.estimator.update(MotionCaptureReading{.time = sim_time(500'000'000)}) ==
        Intake::kRepeated);

  CHECK(bench.estimator.estimate().p_WB_m == before.p_WB_m);
  CHECK(bench.estimator.estimate().is_finite());
}

TEST_CASE("an old motion-capture reading is compared with where the body was then") {
  Estimator estimator{EstimatorParameters{.gravity_mps2 = kGravity}};
  const Eigen::Vector3d v_mps{10.0, 0.0, 0.0};
  const auto position = [&](std::int64_t ms) {
    return Eigen::Vector3d{v_mps * static_cast<double>(ms) * 1e-3};
  };
  for (std::int64_t ms = 0; ms <= 2000; ms += 5) {
    estimator.update(ImuReading{.time = sim_time(ms * 1'000'000),
                                .specific_force_B_mps2 = {0.0, 0.0, kGravity}});
    if (ms >= 20 && ms % 10 == 0) {
      // What was seen 20 ms ago arrives now.
      estimator.update(MotionCaptureReading{.time = sim_time((ms - 20) * 1'000'000),
                                            .p_WB_m = position(ms - 20)});
    }
  }

  // Uncompensated, 20 ms at 10 m/s would be 0.2 m.
  CHECK((estimator.estimate().p_WB_m - position(2000)).norm() < 0.005);
}

}  // namespace
}  // namespace cuscus::flight
