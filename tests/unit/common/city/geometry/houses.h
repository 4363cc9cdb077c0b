#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/city/city.h"
#include "common/random/counter_stream.h"

// Small cities for tests.
namespace cuscus::city {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Of the random questions, one in so many is asked under sanitizers: bad memory shows in fewer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kOneIn = 20;
#else
inline constexpr int kOneIn = 1;
#endif

inline Ring rectangle(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

inline Ring clockwise(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

inline Building building(std::vector<Prism> prisms, double room_m = 0.0) {
  Building result;
  result.osm_id = 7;
  result.prisms = std::move(prisms);
  result.room_m = room_m;
  return result;
}

inline Building house(const Ring& outer, double top_m, double bottom_m = 0.0) {
  return building(
      {{.footprint = {.outer = outer, .courtyards = {}}, .bottom_m = bottom_m, .top_m = top_m}});
}

/// As UprightBox: lengths along its axes, turned counter-clockwise about its centre.
inline Ring turned_rectangle(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& size_m,
                             double heading_rad) {
  Ring ring = rectangle(-0.5 * size_m.x(), -0.5 * size_m.y(), 0.5 * size_m.x(), 0.5 * size_m.y());
  for (Eigen::Vector2d& corner : ring) {
    corner = centre_m + Eigen::Rotation2Dd{heading_rad} * corner;
  }
  return ring;
}

inline City city_of(std::vector<Building> buildings) {
  City city;
  city.buildings = std::move(buildings);
  return city;
}

/// Draws in order.
struct Draws {
  random::CounterStream stream;
  std::uint64_t next{0};

  double uniform(double low, double high) { return low + (high - low) * stream.uniform(next++); }
  std::uint32_t below(std::uint32_t bound) { return stream.below(next++, bound); }
  Eigen::Vector3d place(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    return {uniform(low.x(), high.x()), uniform(low.y(), high.y()), uniform(low.z(), high.z())};
  }
};

/// A star of 5 to 12 corners around a centre: convex hardly ever, and never crossing itself.
inline Ring star(Draws& draws, const Eigen::Vector2d& centre_m, double radius_m) {
  const std::uint32_t corners = 5 + draws.below(8);
  Ring ring;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle_rad = 2.0 * 3.141592653589793 * i / corners;
    ring.push_back(centre_m + draws.uniform(0.5, 1.0) * radius_m *
                                  Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)});
  }
  return ring;
}

/// 36 stars 300 m by 300 m apart, every third with a courtyard, every fourth on stilts.
inline City town_of_stars(std::uint64_t seed) {
  Draws draws{random::CounterStream{seed, 1}};
  City city;
  for (int i = 0; i < 36; ++i) {
    const Eigen::Vector2d centre_m{25.0 + 50.0 * (i % 6), 25.0 + 50.0 * (i / 6)};
    Prism prism{.footprint = {.outer = star(draws, centre_m, 24.0), .courtyards = {}},
                .bottom_m = i % 4 == 0 ? 4.0 : 0.0,
                .top_m = draws.uniform(8.0, 40.0)};
    if (i % 3 == 0) {
      prism.footprint.courtyards.push_back(
          clockwise(turned_rectangle(centre_m, {8.0, 6.0}, draws.uniform(0.0, 3.0))));
    }
    city.buildings.push_back(building({prism}, 5.0));
  }
  return city;
}

/// 12 by 12 cells of 1 m: empty, or part of a building of which every other cell around is one too,
/// in storeys of heights that are halves. Walls, corners and edges are on whole numbers.
inline City city_of_cells(std::uint64_t seed) {
  Draws draws{random::CounterStream{seed, 2}};
  std::vector<Building> blocks(16);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) {
      if (draws.below(3) == 0) {
        continue;
      }
      Building& block = blocks[static_cast<std::size_t>(x / 3 + 4 * (y / 3))];
      block.osm_id = 1 + x / 3 + 4 * (y / 3);
      const Ring cell = rectangle(x, y, x + 1.0, y + 1.0);
      const double storey_m = 0.5 + draws.below(4);
      const double top_m = storey_m + 1.0 + draws.below(3);
      const bool bridge = draws.below(4) == 0;
      if (!bridge) {
        block.prisms.push_back(
            {.footprint = {.outer = cell, .courtyards = {}}, .bottom_m = 0.0, .top_m = storey_m});
      }
      block.prisms.push_back(
          {.footprint = {.outer = cell, .courtyards = {}}, .bottom_m = storey_m, .top_m = top_m});
    }
  }
  City city;
  for (Building& block : blocks) {
    if (!block.prisms.empty()) {
      city.buildings.push_back(std::move(block));
    }
  }
  return city;
}

}  // namespace cuscus::city
