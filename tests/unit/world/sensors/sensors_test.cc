#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "world/sensors/imu.h"
#include "world/sensors/motion_capture.h"

namespace cuscus::world {
namespace {

constexpr std::uint64_t kReadings = 20'000;

struct Moments {
  double mean{0.0};
  double deviation{0.0};
};

Moments moments(const std::vector<double>& samples) {
  Moments m;
  for (const double x : samples) {
    m.mean += x / static_cast<double>(samples.size());
  }
  for (const double x : samples) {
    m.deviation += (x - m.mean) * (x - m.mean) / static_cast<double>(samples.size());
  }
  m.deviation = std::sqrt(m.deviation);
  return m;
}

// Over n readings the mean of noise has deviation sigma / sqrt(n), its deviation is known to
// sigma / sqrt(2 n): five of those are allowed, and the seed is fixed.
void check_noise(const std::vector<double>& errors, double sigma) {
  const Moments m = moments(errors);
  const auto n = static_cast<double>(errors.size());
  CHECK(std::abs(m.mean) < 5.0 * sigma / std::sqrt(n));
  CHECK(std::abs(m.deviation - sigma) < 5.0 * sigma / std::sqrt(2.0 * n));
}

TEST_CASE("an IMU's noise has the deviation asked for, on every axis and apart from the others") {
  const Imu imu{7, 3, {.gyro_radps = 0.01, .accelerometer_mps2 = 0.2}};
  const ImuSample truth{.angular_rate_B_radps = {1.0, -2.0, 0.5},
                        .specific_force_B_mps2 = {0.1, 0.2, 9.81}};
  std::array<std::vector<double>, 6> errors;

  for (std::uint64_t k = 0; k < kReadings; ++k) {
    const ImuSample sample = imu.sample(truth, k);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      errors[axis].push_back(sample.angular_rate_B_radps[i] - truth.angular_rate_B_radps[i]);
      errors[axis + 3].push_back(sample.specific_force_B_mps2[i] - truth.specific_force_B_mps2[i]);
    }
  }

  for (std::size_t i = 0; i < 6; ++i) {
    CAPTURE(i);
    check_noise(errors[i], i < 3 ? 0.01 : 0.2);
    for (std::size_t j = i + 1; j < 6; ++j) {
      double correlation = 0.0;
      for (std::size_t k = 0; k < kReadings; ++k) {
        correlation += errors[i][k] * errors[j][k] / static_cast<double>(kReadings);
      }
      correlation /= moments(errors[i]).deviation * moments(errors[j]).deviation;
      CHECK(std::abs(correlation) < 5.0 / std::sqrt(static_cast<double>(kReadings)));
    }
  }
}

TEST_CASE("motion capture errs in position and attitude as asked for") {
  const MotionCapture motion_capture{7, 3, {.position_m = 0.002, .attitude_rad = 0.005}};
  const MotionCaptureSample truth{.p_WB_m = {10.0, -4.0, 3.0},
                                  .q_WB = Eigen::Quaterniond{Eigen::AngleAxisd{
                                      1.2, Eigen::Vector3d{1.0, 2.0, -1.0}.normalized()}}};
  std::array<std::vector<double>, 6> errors;

  for (std::uint64_t k = 0; k < kReadings; ++k) {
    const MotionCaptureSample sample = motion_capture.sample(truth, k);
    CHECK(std::abs(sample.q_WB.norm() - 1.0) < 1e-14);
    // Of a small rotation, twice the vector part is the rotation vector.
    const Eigen::Vector3d turn = 2.0 * (truth.q_WB.conjugate() * sample.q_WB).vec();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      errors[axis].push_back(sample.p_WB_m[i] - truth.p_WB_m[i]);
      errors[axis + 3].push_back(turn[i]);
    }
  }

  for (std::size_t i = 0; i < 6; ++i) {
    CAPTURE(i);
    check_noise(errors[i], i < 3 ? 0.002 : 0.005);
  }
}

TEST_CASE("a reading does not depend on the readings before it, nor on those of others") {
  const ImuNoise noise{.gyro_radps = 1.0, .accelerometer_mps2 = 1.0};
  const Imu asked_in_order{1, 2, noise};
  const Imu asked_backwards{1, 2, noise};
  const Imu of_another_node{1, 3, noise};
  const Imu of_another_seed{2, 2, noise};
  const ImuSample truth{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::vector<Eigen::Vector3d> forwards;
  for (std::uint64_t k = 0; k < 100; ++k) {
    forwards.push_back(asked_in_order.sample(truth, k).angular_rate_B_radps);
    static_cast<void>(of_another_node.sample(truth, k));
  }

  for (std::uint64_t k = 100; k-- > 0;) {
    CHECK(asked_backwards.sample(truth, k).angular_rate_B_radps == forwards[k]);
    CHECK(of_another_node.sample(truth, k).angular_rate_B_radps != forwards[k]);
    CHECK(of_another_seed.sample(truth, k).angular_rate_B_radps != forwards[k]);
  }
}

TEST_CASE("sensors without noise tell the truth") {
  const Imu imu{1, 2, {.gyro_radps = 0.0, .accelerometer_mps2 = 0.0}};
  const MotionCapture motion_capture{1, 2, {.position_m = 0.0, .attitude_rad = 0.0}};
  const ImuSample felt{.angular_rate_B_radps = {1.0, 2.0, 3.0},
                       .specific_force_B_mps2 = {0.0, 0.0, 9.81}};
  const MotionCaptureSample seen{.p_WB_m = {1.0, 2.0, 3.0},
                                 .q_WB = Eigen::Quaterniond{0.5, 0.5, 0.5, 0.5}};

  CHECK(imu.sample(felt, 5).angular_rate_B_radps == felt.angular_rate_B_radps);
  CHECK(imu.sample(felt, 5).specific_force_B_mps2 == felt.specific_force_B_mps2);
  CHECK(motion_capture.sample(seen, 5).p_WB_m == seen.p_WB_m);
  CHECK(motion_capture.sample(seen, 5).q_WB.coeffs() == seen.q_WB.coeffs());
}

}  // namespace
}  // namespace cuscus::world
