#include "common/city/export/triangulate.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tests/unit/common/city/export/sample_city.h"

namespace cuscus::city {
namespace {

double turn_of(const FlatMesh& mesh, const Triangle& t) {
  const Eigen::Vector2d u = mesh.corners[t[1]] - mesh.corners[t[0]];
  const Eigen::Vector2d v = mesh.corners[t[2]] - mesh.corners[t[0]];
  return u.x() * v.y() - u.y() * v.x();
}

double signed_area(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto& a = ring[i];
    const auto& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2.0;
}

/// Triangles turn left, have the footprint's area together, and each ring's side belongs to one
/// triangle, every other side to two in opposite directions: then they cover it exactly.
void check_covers(const Footprint& footprint) {
  const FlatMesh mesh = triangulated(footprint);
  double expected_m2 = signed_area(footprint.outer);
  std::size_t corners = footprint.outer.size();
  for (const Ring& courtyard : footprint.courtyards) {
    expected_m2 += signed_area(courtyard);
    corners += courtyard.size();
  }
  REQUIRE(mesh.corners.size() == corners);
  // A polygon of n corners and h holes has n + 2h - 2 triangles.
  REQUIRE(mesh.triangles.size() == corners + 2 * footprint.courtyards.size() - 2);
  double area_m2 = 0.0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const Triangle& t : mesh.triangles) {
    REQUIRE(turn_of(mesh, t) > 0.0);
    area_m2 += turn_of(mesh, t) / 2.0;
    for (std::size_t i = 0; i < 3; ++i) {
      ++sides[{t[i], t[(i + 1) % 3]}];
    }
  }
  REQUIRE(area_m2 == Approx(expected_m2).epsilon(1e-9));
  std::uint32_t first = 0;
  const auto check_ring = [&](const Ring& ring) {
    const auto count = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::pair side{first + i, first + (i + 1) % count};
      REQUIRE(sides[side] == 1);
      sides.erase(side);
    }
    first += count;
  };
  check_ring(footprint.outer);
  for (const Ring& courtyard : footprint.courtyards) {
    check_ring(courtyard);
  }
  for (const auto& [side, count] : sides) {
    REQUIRE(count == 1);
    REQUIRE(sides.count({side.second, side.first}) == 1);
  }
}

/// A star of 2 n corners: half of them turn inwards.
Ring star(std::size_t points, double outer_m, double inner_m) {
  Ring ring;
  for (std::size_t i = 0; i < 2 * points; ++i) {
    const double angle_rad =
        std::numbers::pi * static_cast<double>(i) / static_cast<double>(points);
    const double radius_m = i % 2 == 0 ? outer_m : inner_m;
    ring.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad));
  }
  return ring;
}

}  // namespace

TEST_CASE("A square is two triangles, a comb and a star are covered") {
  check_covers({square_ring(0.0, 0.0, 10.0), {}});
  check_covers({{{0, 0},
                 {9, 0},
                 {9, 5},
                 {8, 5},
                 {8, 1},
                 {6, 1},
                 {6, 5},
                 {5, 5},
                 {5, 1},
                 {1, 1},
                 {1, 5},
                 {0, 5}},
                {}});
  check_covers({star(50, 20.0, 5.0), {}});
}

TEST_CASE("Corners in the middle of a straight wall are kept") {
  check_covers({{{0, 0}, {5, 0}, {10, 0}, {10, 10}, {5, 10}, {0, 10}, {0, 5}}, {}});
}

TEST_CASE("A footprint with courtyards is covered outside of them") {
  check_covers({square_ring(0.0, 0.0, 10.0), {square_courtyard(3.0, 3.0, 4.0)}});
  // One behind the other, seen from the east, and two beside each other.
  check_covers({square_ring(0.0, 0.0, 100.0),
                {square_courtyard(10.0, 10.0, 20.0), square_courtyard(50.0, 12.0, 10.0),
                 square_courtyard(70.0, 60.0, 20.0), square_courtyard(20.0, 60.0, 30.0)}});
}

TEST_CASE("A courtyard is joined past corners that turn inwards") {
  // The bay from the east has its end between the courtyard and the wall that a ray hits first.
  check_covers({{{0, 0}, {40, 0}, {40, 18}, {20, 21.5}, {40, 20.5}, {40, 40}, {0, 40}},
                {square_courtyard(5.0, 15.0, 10.0)}});
  Ring inner = star(6, 8.0, 3.0);
  std::reverse(inner.begin(), inner.end());
  check_covers({star(12, 30.0, 18.0), {inner}});
}

TEST_CASE("Grids of courtyards are covered") {
  Footprint footprint{square_ring(0.0, 0.0, 100.0), {}};
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      footprint.courtyards.push_back(square_courtyard(5.0 + 15.0 * column, 5.0 + 15.0 * row, 8.0));
    }
  }
  check_covers(footprint);
}

TEST_CASE("A footprint that crosses itself ends in some triangles, and ends") {
  const FlatMesh mesh = triangulated({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}});
  REQUIRE(mesh.triangles.size() == 2);
  REQUIRE(triangulated({{{0, 0}, {1, 1}}, {}}).triangles.empty());
}

}  // namespace cuscus::city
