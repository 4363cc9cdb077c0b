#include "netsim/channel/antenna.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace cuscus::netsim {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRightAngle_rad = std::numbers::pi / 2.0;

/// At an azimuth and an elevation.
Vector3d direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * std::numbers::pi / 180.0;
  const double e = elevation_deg * std::numbers::pi / 180.0;
  return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

TEST_CASE("a half-wave dipole has the gains of its formula, and a floor along its axis") {
  const HalfWaveDipole dipole;

  CHECK(dipole.gain({3.0, -4.0, 0.0}).value == Approx(2.1509).margin(1e-4));
  // 1.64092 (cos(1.11072) / sin(0.785398))^2 = 1.64092 (0.44401 / 0.70711)^2 = 0.64701.
  CHECK(dipole.gain({5.0, 0.0, 5.0}).value == Approx(-1.8909).margin(1e-4));
  CHECK(dipole.gain({5.0, 0.0, -5.0}).value == Approx(-1.8909).margin(1e-4));
  CHECK(dipole.gain({0.0, 0.0, 7.0}).value == -30.0);
  CHECK(dipole.gain({1e-9, 0.0, -7.0}).value == -30.0);
}

TEST_CASE("a dipole radiates what it is fed") {
  // Mean of the gain over the sphere, in rings: the integral of G cos(e) / 2 over the elevation.
  const HalfWaveDipole dipole;
  double mean = 0.0;
  constexpr int kRings = 1800;
  for (int ring = 0; ring < kRings; ++ring) {
    const double elevation_deg = -90.0 + 180.0 * (ring + 0.5) / kRings;
    const double e = elevation_deg * std::numbers::pi / 180.0;
    mean += dipole.gain(direction(30.0, elevation_deg)).ratio() * std::cos(e) / 2.0 *
            (std::numbers::pi / kRings);
  }

  CHECK(mean == Approx(1.0).margin(0.005));
}

TEST_CASE("a body that turns takes its antenna along") {
  const HalfWaveDipole dipole;
  const AntennaPose low{.p_WB = {0.0, 0.0, 10.0}};
  const AntennaPose above{.p_WB = {0.0, 0.0, 60.0}};
  const AntennaPose rolled{.p_WB = above.p_WB,
                           .q_WB = Quaterniond{AngleAxisd{kRightAngle_rad, Vector3d::UnitX()}}};

  CHECK(gain_of_both(dipole, low, above).value == -60.0);
  CHECK(gain_of_both(dipole, low, rolled).value == Approx(-30.0 + 2.1509).margin(1e-4));
}

TEST_CASE("a yaw turns a pattern counter-clockwise") {
  // 1 dBi ahead, 2 to the left, 3 behind, 4 to the right.
  const AntennaPattern pattern{{1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0, 4.0}, 4};
  const AntennaPose east{.p_WB = {0.0, 0.0, 0.0}};
  const AntennaPose turned{.p_WB = {0.0, 0.0, 0.0},
                           .q_WB = Quaterniond{AngleAxisd{kRightAngle_rad, Vector3d::UnitZ()}}};
  const AntennaPose other{.p_WB = {0.0, 9.0, 0.0}};

  // The other sees the first in the south, which is its right.
  CHECK(gain_of_both(pattern, east, other).value == Approx(2.0 + 4.0));
  CHECK(gain_of_both(pattern, turned, other).value == Approx(1.0 + 4.0));
}

TEST_CASE("a pattern is interpolated in both angles and across north") {
  // Elevations -90, 0, 90; azimuths 0, 90, 180, 270.
  const AntennaPattern pattern{{-20, -20, -20, -20, 6, 2, -10, -2, 0, 0, 0, 0}, 4};
  struct Row {
    double azimuth_deg;
    double elevation_deg;
    double gain_dbi;
  };
  const auto row =
      GENERATE(Row{0, 0, 6}, Row{90, 0, 2}, Row{180, 0, -10}, Row{-90, 0, -2}, Row{45, 0, 4},
               Row{22.5, 0, 5}, Row{315, 0, 2}, Row{-9, 0, 5.2}, Row{0, 45, 3}, Row{45, 45, 2},
               Row{225, -45, -13}, Row{10, 90, 0}, Row{10, -90, -20}, Row{-1e-18, 0, 6});

  CHECK(pattern.gain(5.0 * direction(row.azimuth_deg, row.elevation_deg)).value ==
        Approx(row.gain_dbi).margin(1e-9));
}

TEST_CASE("a link's gain is the same in both directions, and 0 dB without a direction") {
  const HalfWaveDipole dipole;
  const AntennaPose a{.p_WB = {1.0, -2.0, 30.0},
                      .q_WB = Quaterniond{AngleAxisd{0.3, Vector3d{1, 2, 3}.normalized()}}};
  const AntennaPose b{.p_WB = {41.0, 17.0, 55.0},
                      .q_WB = Quaterniond{AngleAxisd{-0.7, Vector3d{0, 1, 1}.normalized()}}};

  CHECK(gain_of_both(dipole, a, b).value == gain_of_both(dipole, b, a).value);
  CHECK(gain_of_both(dipole, a, a).value == 0.0);
}

TEST_CASE("isotropic antennas are none, and what is no antenna is refused") {
  CHECK(make_antenna({}) == nullptr);
  CHECK(make_antenna({.model = "dipole"}) != nullptr);
  CHECK_THROWS_WITH(make_antenna({.model = "yagi"}), Catch::Contains("'dipole'"));
  CHECK_THROWS_WITH(make_antenna({.model = "pattern"}), Catch::Contains("at least 2 elevations"));
  CHECK_THROWS_WITH(
      make_antenna({.model = "pattern", .pattern_dbi = {1, 2, 3}, .pattern_azimuths = 2}),
      Catch::Contains("every azimuth"));
  CHECK_THROWS_WITH(
      make_antenna({.model = "pattern", .pattern_dbi = {1, NAN}, .pattern_azimuths = 1}),
      Catch::Contains("finite"));
}

}  // namespace
}  // namespace cuscus::netsim
