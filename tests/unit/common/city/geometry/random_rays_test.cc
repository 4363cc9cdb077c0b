#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

struct Ray {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

/// Of every kind: anywhere; from corner to corner; along walls and roofs; upright; of no length; on
/// the lattice of the cells.
Ray ray_of_any_kind(Draws& draws, const City& city, const Eigen::Vector3d& high) {
  const Eigen::Vector3d low{-2.0, -2.0, -1.0};
  const auto corner = [&] {
    const Building& building =
        city.buildings[draws.below(static_cast<std::uint32_t>(city.buildings.size()))];
    const Prism& prism =
        building.prisms[draws.below(static_cast<std::uint32_t>(building.prisms.size()))];
    const Ring& ring = prism.footprint.outer;
    const Eigen::Vector2d p = ring[draws.below(static_cast<std::uint32_t>(ring.size()))];
    return Eigen::Vector3d{p.x(), p.y(), draws.below(2) == 0 ? prism.bottom_m : prism.top_m};
  };
  const auto whole = [&] {
    const Eigen::Vector3d p = draws.place(low, high);
    return Eigen::Vector3d{std::round(2.0 * p.x()) / 2.0, std::round(2.0 * p.y()) / 2.0,
                           std::round(2.0 * p.z()) / 2.0};
  };
  const Eigen::Vector3d a = draws.place(low, high);
  switch (draws.below(8)) {
    case 0:
      return {corner(), corner()};
    case 1: {  // through a corner
      const Eigen::Vector3d p = corner();
      return {a, p + (p - a)};
    }
    case 2: {  // along a wall, a roof's edge or an upright one, and beyond
      const Eigen::Vector3d p = corner();
      const Eigen::Vector3d q = corner();
      return {p - (q - p), q + (q - p)};
    }
    case 3:
      return {a, {a.x(), a.y(), draws.uniform(low.z(), high.z())}};
    case 4:
      return {whole(), whole()};
    case 5: {  // level, at a roof's height
      const double z = corner().z();
      const Eigen::Vector3d b = draws.place(low, high);
      return {{a.x(), a.y(), z}, {b.x(), b.y(), z}};
    }
    case 6:
      return {a, draws.below(2) == 0 ? a : corner()};
    default:
      return {a, draws.place(low, high)};
  }
}

bool same(const Crossings& x, const Crossings& y) {
  const auto key = [](const Crossing& c) {
    return std::tuple{c.building,    c.first,       c.intervals, c.from_inside, c.to_inside,
                      c.outer_walls, c.inner_walls, c.length_m,  c.level_m,     c.mean_inner_walls};
  };
  return std::equal(x.buildings.begin(), x.buildings.end(), y.buildings.begin(), y.buildings.end(),
                    [&](const Crossing& c, const Crossing& d) { return key(c) == key(d); }) &&
         std::equal(x.inside.begin(), x.inside.end(), y.inside.begin(), y.inside.end(),
                    [](const Interval& i, const Interval& j) {
                      return i.begin == j.begin && i.end == j.end;
                    });
}

TEST_CASE("of 100 000 rays, grazing ones too, the tree of boxes misses nothing") {
  const bool cells = GENERATE(true, false);
  const City city = cells ? city_of_cells(1) : town_of_stars(1);
  const Eigen::Vector3d high =
      cells ? Eigen::Vector3d{14.0, 14.0, 8.0} : Eigen::Vector3d{302.0, 302.0, 45.0};
  const CityGeometry geometry{city};
  Draws draws{random::CounterStream{2, 3}};

  int wrong = 0;
  int one_way = 0;
  std::uint64_t walls = 0;
  Crossings found;
  Crossings backwards;
  Crossings one_by_one;
  for (int i = 0; i < 50'000 / kOneIn; ++i) {
    const Ray ray = ray_of_any_kind(draws, city, high);
    geometry.crossings(ray.a, ray.b, found);
    one_by_one.buildings.clear();
    one_by_one.inside.clear();
    for (std::uint32_t b = 0; b < city.buildings.size(); ++b) {
      geometry.append_crossing(b, ray.a, ray.b, one_by_one);
    }
    wrong += same(found, one_by_one) ? 0 : 1;
    wrong += geometry.blocked(ray.a, ray.b) != found.buildings.empty() ? 0 : 1;
    geometry.crossings(ray.b, ray.a, backwards);
    one_way += std::equal(found.buildings.begin(), found.buildings.end(),
                          backwards.buildings.begin(), backwards.buildings.end(),
                          [](const Crossing& there, const Crossing& back) {
                            return there.building == back.building &&
                                   there.outer_walls == back.outer_walls &&
                                   there.inner_walls == back.inner_walls &&
                                   there.from_inside == back.to_inside &&
                                   there.length_m == back.length_m;
                          })
                   ? 0
                   : 1;
    for (const Crossing& crossing : found.buildings) {
      walls += crossing.outer_walls;
    }
  }

  CHECK(wrong == 0);
  CHECK(one_way == 0);
  CHECK(walls > 50'000 / kOneIn);
}

/// Walls without those of a corner that is only cut by a hair.
std::map<std::uint32_t, std::uint32_t> walls_by_building(const Crossings& found, double length_m) {
  constexpr double kCut_m = 1e-5;
  std::map<std::uint32_t, std::uint32_t> walls;
  for (const Crossing& crossing : found.buildings) {
    std::uint32_t of_cuts = 0;
    for (const Interval& part : found.of(crossing)) {
      of_cuts += (part.end - part.begin) * length_m < kCut_m ? 2U : 0U;
    }
    if (2 * crossing.intervals > of_cuts) {
      walls[crossing.building] = crossing.outer_walls - of_cuts;
    }
  }
  return walls;
}

TEST_CASE(
    "a level ray through corners and along roofs counts as one a hair to its left and above") {
  const City city = city_of_cells(4);
  const CityGeometry geometry{city};
  Draws draws{random::CounterStream{5, 6}};
  const auto half = [&](std::uint32_t bound) { return draws.below(bound) + 0.5; };

  // Ends amid cells, so that they are on no wall; heights at which floors and roofs are.
  int touched = 0;
  Crossings at;
  Crossings beside;
  for (int i = 0; i < 20'000 / kOneIn; ++i) {
    const double z = draws.below(10) / 2.0;
    const Ray ray{{half(12), half(12), z}, {half(12), half(12), z}};
    if (ray.a.head<2>() == ray.b.head<2>()) {
      continue;
    }
    // Nothing else of the lattice is as near as this to a ray: at most 17 m long, corners are 1/34
    // m apart from it or on it.
    constexpr double kHair_m = 1e-7;
    const bool east = std::tuple{ray.a.x(), ray.a.y()} < std::tuple{ray.b.x(), ray.b.y()};
    const Eigen::Vector2d way = (east ? 1.0 : -1.0) * (ray.b - ray.a).head<2>().normalized();
    const Eigen::Vector3d hair{-way.y() * kHair_m, way.x() * kHair_m, kHair_m};
    geometry.crossings(ray.a, ray.b, at);
    geometry.crossings(ray.a + hair, ray.b + hair, beside);
    const double length_m = (ray.b - ray.a).norm();
    const bool equal = walls_by_building(at, length_m) == walls_by_building(beside, length_m);
    INFO(ray.a.transpose() << " to " << ray.b.transpose());
    CHECK(equal);
    geometry.crossings(ray.a - hair, ray.b - hair, beside);
    touched += walls_by_building(at, length_m) != walls_by_building(beside, length_m) ? 1 : 0;
  }
  CHECK(touched > 100 / kOneIn);  // for these the side has made the difference
}

}  // namespace
}  // namespace cuscus::city
