#include <algorithm>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_linestring.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/flat_polygon.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

namespace bg = boost::geometry;
using FlatLine = bg::model::linestring<FlatPoint>;

struct RandomRay {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

/// What of a segment is inside a prism, by Boost.Geometry's intersection of its footprint with the
/// part of the segment that is between bottom and top.
struct OracleCrossing {
  std::uint32_t walls{0};
  double level_m{0.0};
  bool doubtful{false};  ///< Something of it is too short to be sure of, or a gap a seam.
};

OracleCrossing oracle(const FlatPolygon& polygon, const Prism& prism, const RandomRay& ray) {
  constexpr double kDoubtful_m = 1e-6;
  const double bottom_m = prism.bottom_m > 0.0 ? prism.bottom_m : -1000.0;
  const double rise_m = ray.b.z() - ray.a.z();
  const double at_bottom = (bottom_m - ray.a.z()) / rise_m;
  const double at_top = (prism.top_m - ray.a.z()) / rise_m;
  const double begin = std::max(0.0, std::min(at_bottom, at_top));
  const double end = std::min(1.0, std::max(at_bottom, at_top));
  OracleCrossing result;
  if (begin >= end) {
    return result;
  }
  const Eigen::Vector3d from = ray.a + begin * (ray.b - ray.a);
  const Eigen::Vector3d to = ray.a + end * (ray.b - ray.a);
  const FlatLine line{{from.x(), from.y()}, {to.x(), to.y()}};
  bg::model::multi_linestring<FlatLine> inside;
  bg::intersection(line, polygon, inside);
  const bool from_inside = begin == 0.0 && bg::within(line.front(), polygon);
  const bool to_inside = end == 1.0 && bg::within(line.back(), polygon);
  for (const FlatLine& part : inside) {
    const auto length_m = static_cast<double>(bg::length(part));
    result.level_m += length_m;
    result.doubtful = result.doubtful || length_m < kDoubtful_m;
  }
  constexpr double kSeam_m = 1.1e-3;  // CityGeometry closes gaps of 1 mm, level or aslant
  for (const FlatLine& x : inside) {
    for (const FlatLine& y : inside) {
      result.doubtful = result.doubtful || (&x != &y && bg::distance(x, y) < kSeam_m);
    }
  }
  const auto parts = static_cast<std::uint32_t>(inside.size());
  result.walls = 2 * parts - (from_inside ? 1U : 0U) - (to_inside ? 1U : 0U);
  return result;
}

double level_distance_m(const RandomRay& ray, const Eigen::Vector2d& p) {
  const Eigen::Vector2d way = (ray.b - ray.a).head<2>();
  const Eigen::Vector2d from_a = p - ray.a.head<2>();
  return (from_a - std::clamp(from_a.dot(way) / way.squaredNorm(), 0.0, 1.0) * way).norm();
}

TEST_CASE("walls and lengths of 20 000 random rays are those that Boost.Geometry finds") {
  const City city = town_of_stars(7);
  const CityGeometry geometry{city};
  std::vector<FlatPolygon> polygons;
  for (const Building& building : city.buildings) {
    polygons.push_back(flat(building.prisms[0].footprint));
  }
  Draws draws{random::CounterStream{8, 9}};

  int doubtful = 0;
  int walled = 0;
  Crossings found;
  for (int i = 0; i < 20'000 / kOneIn; ++i) {
    const RandomRay ray{draws.place({0.0, 0.0, 0.0}, {300.0, 300.0, 42.0}),
                        draws.place({0.0, 0.0, 0.0}, {300.0, 300.0, 42.0})};
    geometry.crossings(ray.a, ray.b, found);
    for (std::uint32_t b = 0; b < city.buildings.size(); ++b) {
      const auto crossing = std::find_if(found.buildings.begin(), found.buildings.end(),
                                         [b](const Crossing& each) { return each.building == b; });
      const bool crossed = crossing != found.buildings.end();
      // Boost.Geometry is asked where the ray comes near: no star reaches further than 24 m.
      const Eigen::Vector2d centre_m{25.0 + 50.0 * (b % 6), 25.0 + 50.0 * (b / 6)};
      if (level_distance_m(ray, centre_m) > 24.0) {
        REQUIRE_FALSE(crossed);
        continue;
      }
      const OracleCrossing expected = oracle(polygons[b], city.buildings[b].prisms[0], ray);
      if (expected.doubtful) {
        ++doubtful;
        continue;
      }
      INFO(ray.a.transpose() << " to " << ray.b.transpose() << ", building " << b);
      REQUIRE((crossed ? crossing->outer_walls : 0U) == expected.walls);
      REQUIRE((crossed ? crossing->level_m : 0.0) == Approx(expected.level_m).margin(1e-9));
      walled += crossed ? 1 : 0;
    }
  }
  CHECK(doubtful < 100);
  CHECK(walled > 20'000 / kOneIn);
}

TEST_CASE("distances to shapes that are not convex are those of Boost.Geometry") {
  const City city = town_of_stars(41);
  Draws draws{random::CounterStream{42, 43}};

  for (int i = 0; i < 2000 / kOneIn; ++i) {
    const auto index = static_cast<std::size_t>(i) % city.buildings.size();
    const Prism& prism = city.buildings[index].prisms[0];
    const FlatPolygon polygon = flat(prism.footprint);
    const Eigen::Vector2d& centre = prism.footprint.outer[0];
    const Eigen::Vector3d p = draws.place({centre.x() - 40.0, centre.y() - 40.0, 0.1},
                                          {centre.x() + 40.0, centre.y() + 40.0, 50.0});
    const double bottom_m = prism.bottom_m > 0.0 ? prism.bottom_m : -1000.0;
    const double apart_m = std::max({p.z() - prism.top_m, bottom_m - p.z(), 0.0});
    const double level_m =
        static_cast<double>(boost::geometry::distance(FlatPoint{p.x(), p.y()}, polygon));
    const CityGeometry geometry{city_of({city.buildings[index]})};
    std::vector<Surface> surfaces;
    geometry.surfaces(p, 1000.0, surfaces);

    CHECK(std::max(0.0, surfaces[0].distance_m) ==
          Approx(std::hypot(level_m, apart_m)).margin(1e-9));
    CHECK(geometry.inside(p).has_value() == (level_m == 0.0 && apart_m == 0.0));
    CHECK((p - surfaces[0].distance_m * surfaces[0].normal).isApprox(surfaces[0].p_WS, 1e-9));
  }
}

}  // namespace
}  // namespace cuscus::city
