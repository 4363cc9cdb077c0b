#include "common/city/import/local_frame.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>

namespace cuscus::city {
namespace {

constexpr double kOneMillimetre_m = 1e-3;
constexpr Geodetic kBryantPark{.latitude_deg = 40.752, .longitude_deg = -73.985};
constexpr Geodetic kBologna{.latitude_deg = 44.4938, .longitude_deg = 11.3426, .height_m = 54.0};

struct ProjectedPoint {
  Geodetic point;
  Eigen::Vector3d local_m;
};

// PROJ 9.1.1: printf '-73.99 40.748 0\n...' | cct -d 6 +proj=pipeline +step +proj=cart +ellps=WGS84
//   +step +proj=topocentric +ellps=WGS84 +lon_0=-73.985 +lat_0=40.752 +h_0=0
const std::array<ProjectedPoint, 4> kInManhattan{{
    {{40.748, -73.99, 0.0}, {-422.274061, -444.184287, -0.029463}},
    {{40.756, -73.98, 443.2}, {422.252750, 444.239592, 443.170536}},
    {{40.8, -73.9, 10.0}, {7173.072892, 5333.860928, 3.736528}},
    {{40.7, -74.1, -5.0}, {-9719.269255, -5768.155453, -15.009394}},
}};
// The same with +lon_0=11.3426 +lat_0=44.4938 +h_0=54.
const std::array<ProjectedPoint, 3> kInBologna{{
    {{44.4805, 11.312, 0.0}, {-2434.415475, -1477.463755, -54.635249}},
    {{44.51, 11.382, 97.2}, {3132.976515, 1800.959526, 42.177099}},
    {{44.42, 11.45, 0.0}, {8553.141301, -8195.121624, -64.999766}},
}};

TEST_CASE("a frame agrees with PROJ's topocentric pipeline within a millimetre over 10 km") {
  const LocalFrame manhattan{kBryantPark};
  const LocalFrame bologna{kBologna};

  for (const auto& [point, local_m] : kInManhattan) {
    CHECK((manhattan.to_local(point) - local_m).norm() < kOneMillimetre_m);
  }
  for (const auto& [point, local_m] : kInBologna) {
    CHECK((bologna.to_local(point) - local_m).norm() < kOneMillimetre_m);
  }
}

TEST_CASE("the installed PROJ gives the same on a grid of 20 km by 20 km") {
  if (std::system("command -v cct >/dev/null") != 0) {
    WARN("SKIPPED: needs cct (Debian: proj-bin)");
    return;
  }
  constexpr int kSide = 9;
  const LocalFrame frame{kBologna};
  std::ostringstream command;
  command.precision(12);
  command << "printf '";
  std::array<Geodetic, kSide * kSide> points;
  for (int i = 0; i < kSide * kSide; ++i) {
    // Steps of about 2.5 km each way.
    points[static_cast<std::size_t>(i)] = {
        kBologna.latitude_deg + 0.0225 * (i / kSide - kSide / 2),
        kBologna.longitude_deg + 0.0315 * (i % kSide - kSide / 2), 10.0 * i};
    const Geodetic& point = points[static_cast<std::size_t>(i)];
    command << point.longitude_deg << ' ' << point.latitude_deg << ' ' << point.height_m << "\\n";
  }
  command << "' | cct -d 6 +proj=pipeline +step +proj=cart +ellps=WGS84 +step +proj=topocentric"
             " +ellps=WGS84 +lon_0="
          << kBologna.longitude_deg << " +lat_0=" << kBologna.latitude_deg
          << " +h_0=" << kBologna.height_m;

  std::FILE* const proj = ::popen(command.str().c_str(), "re");
  REQUIRE(proj != nullptr);
  for (const Geodetic& point : points) {
    Eigen::Vector3d expected;
    double time = 0.0;
    REQUIRE(std::fscanf(proj, "%lf %lf %lf %lf", &expected.x(), &expected.y(), &expected.z(),
                        &time) == 4);
    CHECK((frame.to_local(point) - expected).norm() < kOneMillimetre_m);
  }
  CHECK(::pclose(proj) == 0);
}

TEST_CASE("the origin is at zero, and north and up are the axes there") {
  const LocalFrame frame{kBologna};
  Geodetic north = kBologna;
  north.latitude_deg += 1e-5;
  Geodetic above = kBologna;
  above.height_m += 100.0;

  CHECK(frame.to_local(kBologna).norm() < 1e-8);
  CHECK((frame.to_local(above) - Eigen::Vector3d{0.0, 0.0, 100.0}).norm() < 1e-8);
  // The meridian's radius of curvature at 44.4938 degrees: a (1 - e^2) / (1 - e^2 sin^2)^1.5, at
  // the origin's height.
  constexpr double kA_m = 6378137.0;
  constexpr double kE2 = 0.00669437999014;
  const double sine = std::sin(kBologna.latitude_deg * std::numbers::pi / 180.0);
  const double radius_m = kA_m * (1.0 - kE2) / std::pow(1.0 - kE2 * sine * sine, 1.5);
  const double expected_m = (radius_m + kBologna.height_m) * 1e-5 * std::numbers::pi / 180.0;
  CHECK(frame.to_local(north).y() == Approx(expected_m).epsilon(1e-6));
}

TEST_CASE("a point comes back from the frame as it went in") {
  const LocalFrame frame{kBryantPark};
  for (const auto& [point, local_m] : kInManhattan) {
    const Geodetic back = frame.to_geodetic(frame.to_local(point));

    // 1e-11 degrees are about a micrometre.
    CHECK(std::abs(back.latitude_deg - point.latitude_deg) < 1e-11);
    CHECK(std::abs(back.longitude_deg - point.longitude_deg) < 1e-11);
    CHECK(std::abs(back.height_m - point.height_m) < 1e-6);
  }
}

}  // namespace
}  // namespace cuscus::city
