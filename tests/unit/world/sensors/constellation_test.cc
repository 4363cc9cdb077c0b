#include "world/sensors/constellation.h"

#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "world/sensors/position_solution.h"

namespace cuscus::world {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr std::chrono::sys_days kReference{std::chrono::year{1993} / 7 / 1};

Eigen::Matrix3d turn(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd{angle_deg * kDegree_rad, axis}.toRotationMatrix();
}

TEST_CASE("a slot is seen where three rotations and another library put it") {
  const city::Geodetic site{.latitude_deg = -33.9, .longitude_deg = 151.2, .height_m = 75.0};
  const Constellation sky{site, kReference + std::chrono::hours{5}};
  const SimTime time = sim_time(678'000'000'000);
  const double passed_s = 5.0 * 3600.0 + 678.0;

  const auto directions = sky.directions(time);

  // B3 and F2 of table 3-1; radius of the orbit of half a sidereal day; Greenwich 18 h 36 m 14.4 s.
  const auto expected = [&](double ascension_deg, double latitude_deg) -> Eigen::Vector3d {
    const double turned_deg = 360.0 / 86164.0905 * passed_s;
    const Eigen::Vector3d p_E_m =
        turn(ascension_deg - 279.06 - turned_deg, Eigen::Vector3d::UnitZ()) *
        turn(55.0, Eigen::Vector3d::UnitX()) *
        turn(latitude_deg + 2.0 * turned_deg, Eigen::Vector3d::UnitZ()) *
        Eigen::Vector3d{26'561'764.0, 0.0, 0.0};
    double latitude = 0.0;
    double longitude = 0.0;
    double height_m = 0.0;
    GeographicLib::Geocentric::WGS84().Reverse(p_E_m.x(), p_E_m.y(), p_E_m.z(), latitude, longitude,
                                               height_m);
    const GeographicLib::LocalCartesian local{site.latitude_deg, site.longitude_deg, site.height_m};
    Eigen::Vector3d p_W_m;
    local.Forward(latitude, longitude, height_m, p_W_m.x(), p_W_m.y(), p_W_m.z());
    return p_W_m.normalized();
  };
  // The sidereal day is given to 0.1 ms, the radius to 1 m: 1e-7 of a turn and less.
  CHECK((directions[6] - expected(332.847, 309.976)).norm() < 1e-6);
  CHECK((directions[21] - expected(212.847, 345.226)).norm() < 1e-6);
}

TEST_CASE("the sky is the same again after a sidereal day") {
  const Constellation sky{{.latitude_deg = 49.4, .longitude_deg = 2.8, .height_m = 40.0},
                          kReference + std::chrono::days{12'000}};
  const auto first = sky.directions(sim_time(0));
  const auto later = sky.directions(sim_time(3'600'000'000'000));
  const auto next_day = sky.directions(sim_time(86'164'090'500'000));

  for (std::size_t i = 0; i < kSatellites; ++i) {
    // WGS-84's rate makes the day 9 ms longer, in which a satellite moves by 2 µrad at most.
    CHECK((first[i] - next_day[i]).norm() < 2e-6);
    CHECK((first[i] - later[i]).norm() > 0.1);
    CHECK(first[i].norm() == Approx(1.0));
  }
}

TEST_CASE("the sky is as good all over the Earth as the standard asks of its 24 slots") {
  int places = 0;
  int good = 0;
  std::size_t fewest = kSatellites;
  for (double latitude_deg = -90.0; latitude_deg <= 90.0; latitude_deg += 30.0) {
    for (double longitude_deg = -180.0; longitude_deg < 180.0; longitude_deg += 60.0) {
      const Constellation sky{
          {.latitude_deg = latitude_deg, .longitude_deg = longitude_deg, .height_m = 0.0},
          kReference};
      for (std::int64_t minutes = 0; minutes < 24 * 60; minutes += 20) {
        std::vector<Eigen::Vector3d> visible;
        for (const auto& direction : sky.directions(sim_time(minutes * 60'000'000'000))) {
          if (direction.z() >= std::sin(5.0 * kDegree_rad)) {
            visible.push_back(direction);
          }
        }
        const auto solution = PositionSolution::of(visible);
        ++places;
        good += solution && solution->pdop() <= 6.0 ? 1 : 0;
        fewest = std::min(fewest, visible.size());
      }
    }
  }

  // GPS SPS Performance Standard, October 2001, 3.2: PDOP of 6 or less for 98 % or more of place
  // and time, above 5 degrees; 4 satellites or more.
  CHECK(static_cast<double>(good) / places >= 0.98);
  CHECK(fewest >= 4);
}

TEST_CASE(
    "three satellites on the horizon and one above make the dilution that a sheet of paper does") {
  const std::vector<Eigen::Vector3d> directions{{0.0, 0.0, 1.0},
                                                {0.0, 1.0, 0.0},
                                                {std::sqrt(0.75), -0.5, 0.0},
                                                {-std::sqrt(0.75), -0.5, 0.0}};

  const auto solution = PositionSolution::of(directions);

  // GᵀG has 3/2 for east and for north, and ((1, -1), (-1, 4)) for up and clock, whose inverse is
  // ((4, 1), (1, 1)) / 3.
  REQUIRE(solution);
  CHECK(solution->hdop() == Approx(std::sqrt(4.0 / 3.0)));
  CHECK(solution->vdop() == Approx(std::sqrt(4.0 / 3.0)));
  CHECK(solution->pdop() == Approx(std::sqrt(8.0 / 3.0)));
}

TEST_CASE("range errors that a displacement and a clock would make give that displacement") {
  const std::vector<Eigen::Vector3d> directions{
      {0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}, {-0.8, 0.0, 0.6}, {0.0, 0.8, 0.6}, {0.0, -0.6, 0.8}};
  const Eigen::Vector3d displacement_m{3.0, -4.0, 12.0};
  constexpr double kClock_m = 1000.0;
  std::vector<double> errors_m;
  for (const Eigen::Vector3d& direction : directions) {
    errors_m.push_back(kClock_m - direction.dot(displacement_m));
  }

  const auto solution = PositionSolution::of(directions);

  REQUIRE(solution);
  CHECK((solution->error(directions, errors_m) - displacement_m).norm() < 1e-9);
}

TEST_CASE("three satellites, and four on one cone, give no position") {
  std::vector<Eigen::Vector3d> cone;
  for (int i = 0; i < 6; ++i) {
    cone.emplace_back(0.6 * std::cos(i), 0.6 * std::sin(i), 0.8);
  }

  CHECK_FALSE(PositionSolution::of(std::span{cone}.first(3)));
  CHECK_FALSE(PositionSolution::of(std::span{cone}.first(4)));
  CHECK_FALSE(PositionSolution::of(cone));
  cone[5] = {0.0, 0.0, 1.0};
  CHECK(PositionSolution::of(cone));
}

}  // namespace
}  // namespace cuscus::world
