#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/unit/world/blocks.h"
#include "world/sensors/lidar.h"
#include "world/sensors/ultrasonic.h"

namespace cuscus::world {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Eigen::Quaterniond turned(double yaw_rad, double pitch_rad, double roll_rad) {
  return Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()} *
         Eigen::AngleAxisd{pitch_rad, Eigen::Vector3d::UnitY()} *
         Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitX()};
}

/// A wall that faces west at x = 10 m, and one that faces south at y = 8 m; 100 m high.
const city::CityGeometry& walls() {
  static const city::CityGeometry geometry{
      city_of({{.low_m = {10.0, -100.0, 0.0}, .high_m = {20.0, 100.0, 100.0}},
               {.low_m = {-100.0, 8.0, 0.0}, .high_m = {5.0, 20.0, 100.0}}})};
  return geometry;
}

UltrasonicParameters without_noise() {
  UltrasonicParameters parameters;
  parameters.noise_m = 0.0;
  return parameters;
}

TEST_CASE("an ultrasonic sensor measures the height above ground, its own place in mind") {
  const Ultrasonic sensor{1, 0, without_noise()};

  for (const double height_m : {0.0, 1.0, 5.9}) {
    const auto reading = sensor.sample(Surroundings{}, {.p_WB_m = {3.0, 4.0, height_m}}, 0);
    CHECK(reading.value() == Approx(height_m + 0.04));
  }
  CHECK_FALSE(sensor.sample(Surroundings{}, {.p_WB_m = {3.0, 4.0, 5.97}}, 0));
}

TEST_CASE("a tilted ultrasonic sensor hears the nearest point in its cone") {
  const Ultrasonic sensor{1, 0, without_noise()};
  for (const double tilt_deg : {0.0, 10.0, 14.9, 16.0, 20.0, 30.0}) {
    for (const double direction_deg : {0.0, 17.0, 45.0, 100.0, 213.0}) {
      CAPTURE(tilt_deg, direction_deg);
      RigidBodyState body{.p_WB_m = {0.0, 0.0, 3.0}};
      body.q_WB = turned(direction_deg * kDegree, tilt_deg * kDegree, 0.0) *
                  turned(0.3 * direction_deg * kDegree, 0.0, 0.0);

      const double heard_m = sensor.sample(Surroundings{}, body, 0).value();

      // From h above a plane the nearest point of a cone that leans by more than its half angle is
      // on its rim: h / cos(tilt - half angle).
      const double height_m = 3.0 + 0.04 * std::cos(tilt_deg * kDegree);
      const double rim_m = height_m / std::cos(std::max(0.0, tilt_deg - 15.0) * kDegree);
      CHECK(heard_m >= rim_m * (1.0 - 1e-12));
      CHECK(heard_m <= rim_m * (tilt_deg < 15.0 ? 1.0 + 1e-12 : 1.002));
    }
  }
}

TEST_CASE("an ultrasonic sensor that looks ahead measures to the wall, not to the ground below") {
  UltrasonicParameters ahead = without_noise();
  ahead.axis_B = Eigen::Vector3d::UnitX();
  const Ultrasonic sensor{1, 0, ahead};
  const Surroundings city{&walls()};

  CHECK(sensor.sample(city, {.p_WB_m = {7.0, 0.0, 2.5}}, 0).value() == Approx(3.0));
  RigidBodyState turned_left{.p_WB_m = {1.0, 5.0, 50.0}};
  turned_left.q_WB = turned(90.0 * kDegree, 0.0, 0.0);
  CHECK(sensor.sample(city, turned_left, 0).value() == Approx(3.0));
  CHECK_FALSE(sensor.sample(city, {.p_WB_m = {-20.0, 0.0, 50.0}}, 0));
}

TEST_CASE("an ultrasonic sensor errs by its noise, never below 0 or beyond its range") {
  UltrasonicParameters parameters;
  parameters.noise_m = 0.05;
  const Ultrasonic sensor{3, 2, parameters};
  constexpr std::uint64_t kRangings = 5000;
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  bool within = true;

  for (std::uint64_t k = 0; k < kRangings; ++k) {
    const double error_m =
        sensor.sample(Surroundings{}, {.p_WB_m = {0.0, 0.0, 2.96}}, k).value() - 3.0;
    sum_m += error_m;
    squares_m2 += error_m * error_m;
    const double low_m = sensor.sample(Surroundings{}, {}, k).value();
    const double high_m = sensor.sample(Surroundings{}, {.p_WB_m = {0.0, 0.0, 5.95}}, k).value();
    within = within && low_m >= 0.0 && high_m <= 6.0;
  }

  // Five standard deviations of the mean and of the deviation.
  CHECK(std::abs(sum_m / kRangings) < 5.0 * 0.05 / std::sqrt(kRangings));
  CHECK(std::sqrt(squares_m2 / kRangings) == Approx(0.05).epsilon(5.0 / std::sqrt(2 * kRangings)));
  CHECK(within);
}

/// Distance from `p` along `ray` to the nearest of the planes x = 10, y = 8 (as far as x = 5) and
/// z = 0, seen from between them.
double analytic_m(const Eigen::Vector3d& p, const Eigen::Vector3d& ray) {
  double least_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](double distance_m) {
    if (distance_m > 0.0) {
      least_m = std::min(least_m, distance_m);
    }
  };
  offer((10.0 - p.x()) / ray.x());
  const double to_north_m = (8.0 - p.y()) / ray.y();
  if (p.x() + to_north_m * ray.x() <= 5.0 && p.x() + to_north_m * ray.x() >= -100.0) {
    offer(to_north_m);
  }
  offer(-p.z() / ray.z());
  return least_m;
}

TEST_CASE("a lidar of a vehicle that yaws, pitches and rolls agrees with the walls' equations") {
  const std::array<double, 3> turn_deg =
      GENERATE(std::array<double, 3>{0.0, 0.0, 0.0}, std::array<double, 3>{33.0, 0.0, 0.0},
               std::array<double, 3>{-70.0, 12.0, 25.0});
  LidarParameters parameters;
  parameters.elevations_rad = {-30.0 * kDegree, 0.0, 10.0 * kDegree};
  parameters.noise_m = 0.0;
  const Lidar lidar{1, 0, parameters};
  RigidBodyState body{.p_WB_m = {2.0, 1.0, 6.0}};
  body.q_WB = turned(turn_deg[0] * kDegree, turn_deg[1] * kDegree, turn_deg[2] * kDegree);
  std::vector<float> ranges_m(lidar.size());

  lidar.sample(Surroundings{&walls()}, body, 0, ranges_m);

  REQUIRE(lidar.size() == 3 * 360);
  const Eigen::Vector3d place = body.p_WB_m + body.q_WB * Eigen::Vector3d{0.0, 0.0, 0.1};
  int in_range = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::uint32_t k = 0; k < 360; ++k) {
      const double elevation_rad = parameters.elevations_rad[row];
      const double azimuth_rad = (k - 180.0) * kDegree;
      const Eigen::Vector3d ray =
          body.q_WB * Eigen::Vector3d{std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad),
                                      std::sin(elevation_rad)};
      const double expected_m = analytic_m(place, ray);
      const double got_m = ranges_m[row * 360 + k];
      CAPTURE(row, k, expected_m, got_m);
      if (expected_m <= 30.0) {
        ++in_range;
        CHECK(got_m == Approx(expected_m).epsilon(1e-6));  // a float's
      } else {
        CHECK(std::isinf(got_m));
      }
    }
  }
  CHECK(in_range > 400);
}

TEST_CASE("a lidar's rays cover its field from right to left, a circle without meeting itself") {
  const LidarParameters circle{.rays = 8, .field_rad = 360.0 * kDegree};
  const LidarParameters ahead{.rays = 3, .field_rad = 90.0 * kDegree};

  CHECK(lidar_azimuth_rad(circle, 0) == Approx(-180.0 * kDegree));
  CHECK(lidar_azimuth_rad(circle, 4) == Approx(0.0).margin(1e-12));
  CHECK(lidar_azimuth_rad(circle, 7) == Approx(135.0 * kDegree));
  CHECK(lidar_azimuth_rad(ahead, 0) == Approx(-45.0 * kDegree));
  CHECK(lidar_azimuth_rad(ahead, 2) == Approx(45.0 * kDegree));
  CHECK(lidar_azimuth_rad({.rays = 1, .field_rad = 90.0 * kDegree}, 0) == 0.0);
}

TEST_CASE("each ray of each scan has noise of its own") {
  LidarParameters parameters{.rays = 100, .field_rad = 20.0 * kDegree};
  parameters.noise_m = 0.1;
  const Lidar noisy{5, 1, parameters};
  parameters.noise_m = 0.0;
  const Lidar exact{5, 1, parameters};
  const RigidBodyState body{.p_WB_m = {0.0, 0.0, 50.0}};
  std::vector<float> truth_m(100);
  exact.sample(Surroundings{&walls()}, body, 0, truth_m);
  double squares_m2 = 0.0;
  std::vector<float> first_m(100);
  std::vector<float> scan_m(100);
  int repeated = 0;

  noisy.sample(Surroundings{&walls()}, body, 0, first_m);
  for (std::uint64_t reading = 1; reading <= 50; ++reading) {
    noisy.sample(Surroundings{&walls()}, body, reading, scan_m);
    for (std::size_t k = 0; k < 100; ++k) {
      squares_m2 += std::pow(static_cast<double>(scan_m[k]) - static_cast<double>(truth_m[k]), 2);
      repeated += scan_m[k] == first_m[k] ? 1 : 0;
    }
  }

  CHECK(std::sqrt(squares_m2 / 5000.0) == Approx(0.1).epsilon(5.0 / std::sqrt(10000.0)));
  CHECK(repeated < 5);
}

}  // namespace
}  // namespace cuscus::world
