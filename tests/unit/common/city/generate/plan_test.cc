#include "common/city/generate/plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "common/city/generate/grid.h"
#include "common/city/generate/names.h"
#include "common/city/generate/old_town.h"
#include "tests/unit/common/city/generate/plan_shapes.h"

namespace cuscus::city::generate {
namespace {

using Box = bg::model::box<Point>;

// Corners are rounded to whole millimetres: up to 0.71 mm each, at both sides of a street.
constexpr double kRounding_m = 0.0015;
// Corners are common to the last bit where walls are; what is computed of them is good to 1e-10.
constexpr double kNothing_m2 = 1e-8;

struct Shape {
  Polygon polygon;
  Box box;
};

std::vector<Shape> shapes_of(const Plan& plan) {
  std::vector<Shape> shapes;
  for (const PlannedBuilding& building : plan.buildings) {
    Polygon polygon = polygon_of(building.footprint);
    const Box box = bg::return_envelope<Box>(polygon);
    shapes.push_back({std::move(polygon), box});
  }
  return shapes;
}

void check_valid(const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    std::string why;
    CAPTURE(bg::wkt(shape.polygon));
    REQUIRE(bg::is_valid(shape.polygon, why));
    REQUIRE(bg::area(shape.polygon) > 30.0);
  }
}

double total_m2(const std::vector<Polygon>& pieces) {
  double sum_m2 = 0.0;
  for (const Polygon& piece : pieces) {
    sum_m2 += bg::area(piece);
  }
  return sum_m2;
}

double common_m2(const Polygon& a, const Polygon& b) {
  std::vector<Polygon> pieces;
  bg::intersection(a, b, pieces);
  return total_m2(pieces);
}

void check_no_overlap(const std::vector<Shape>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < shapes.size(); ++j) {
      if (bg::intersects(shapes[i].box, shapes[j].box)) {
        CAPTURE(bg::wkt(shapes[i].polygon), bg::wkt(shapes[j].polygon));
        REQUIRE(common_m2(shapes[i].polygon, shapes[j].polygon) < kNothing_m2);
      }
    }
  }
}

constexpr double kNarrowestStreet_m = 2.5;

double distance_to(const Line& line, const std::vector<Shape>& shapes, double reach_m) {
  Box near = bg::return_envelope<Box>(line);
  bg::set<0, 0>(near, bg::get<0, 0>(near) - reach_m);
  bg::set<0, 1>(near, bg::get<0, 1>(near) - reach_m);
  bg::set<1, 0>(near, bg::get<1, 0>(near) + reach_m);
  bg::set<1, 1>(near, bg::get<1, 1>(near) + reach_m);
  double least = reach_m;
  for (const Shape& shape : shapes) {
    if (bg::intersects(near, shape.box)) {
      least = std::min(least, bg::distance(line, shape.polygon));
    }
  }
  return least;
}

/// The axis without its first and last `cut_m`, where the street meets others, which may be
/// narrower.
std::vector<Line> inner_pieces(const std::vector<Eigen::Vector2d>& axis, double cut_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < axis.size(); ++i) {
    length_m += (axis[i] - axis[i - 1]).norm();
  }
  std::vector<Line> pieces;
  double from_m = 0.0;
  for (std::size_t i = 1; i < axis.size(); ++i) {
    const double piece_m = (axis[i] - axis[i - 1]).norm();
    const Eigen::Vector2d along = (axis[i] - axis[i - 1]) / piece_m;
    const double begin_m = std::max(cut_m - from_m, 0.0);
    const double end_m = std::min(length_m - cut_m - from_m, piece_m);
    if (begin_m < end_m) {
      pieces.push_back(line_of({axis[i - 1] + along * begin_m, axis[i - 1] + along * end_m}));
    }
    from_m += piece_m;
  }
  return pieces;
}

/// Not only the axes: between its junctions, a street is free over its whole width.
void check_streets_free(const Plan& plan, const std::vector<Shape>& shapes) {
  for (const PlannedStreet& street : plan.streets) {
    CAPTURE(street.name, bg::wkt(line_of(street.axis_m)));
    REQUIRE(street.axis_m.size() >= 2);
    REQUIRE(distance_to(line_of(street.axis_m), shapes, street.width_m) >=
            kNarrowestStreet_m / 2.0 - kRounding_m);
    for (const Line& piece : inner_pieces(street.axis_m, street.width_m)) {
      REQUIRE(distance_to(piece, shapes, street.width_m) >= street.width_m / 2.0 - kRounding_m);
    }
  }
}

void check_trees_outside(const Plan& plan, const std::vector<Shape>& shapes) {
  for (const Tree& tree : plan.trees) {
    const Point foot{tree.foot_m.x(), tree.foot_m.y()};
    REQUIRE(std::none_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
      return bg::covered_by(foot, shape.box) && bg::covered_by(foot, shape.polygon);
    }));
    REQUIRE(tree.height_m > 2.0 * tree.crown_radius_m - 1e-9);
  }
}

/// Parts fill their building's footprint from the ground on and share no volume.
void check_parts(const PlannedBuilding& building) {
  const Polygon whole = polygon_of(building.footprint);
  double ground_m2 = 0.0;
  double top_m = 0.0;
  for (const Prism& part : building.parts) {
    const Polygon shape = polygon_of(part.footprint);
    REQUIRE(bg::is_valid(shape));
    REQUIRE(part.bottom_m < part.top_m);
    REQUIRE(common_m2(shape, whole) == Approx(bg::area(shape)).margin(kNothing_m2));
    ground_m2 += part.bottom_m == 0.0 ? bg::area(shape) : 0.0;
    top_m = std::max(top_m, part.top_m);
    for (const Prism& other : building.parts) {
      if (&other != &part && part.bottom_m < other.top_m && other.bottom_m < part.top_m) {
        REQUIRE(common_m2(shape, polygon_of(other.footprint)) < kNothing_m2);
      }
    }
  }
  REQUIRE(ground_m2 == Approx(bg::area(whole)).epsilon(1e-9));
  REQUIRE(top_m == building.height_m);
}

void check_inside(const Plan& plan) {
  const auto inside = [&](const Eigen::Vector2d& p) {
    return ((p - plan.south_west_m).array() >= 0.0).all() &&
           ((plan.north_east_m - p).array() >= 0.0).all();
  };
  for (const PlannedStreet& street : plan.streets) {
    for (const Eigen::Vector2d& p : street.axis_m) {
      REQUIRE(inside(p));
    }
  }
  for (const PlannedBuilding& building : plan.buildings) {
    for (const Eigen::Vector2d& p : building.footprint.outer) {
      REQUIRE(inside(p));
    }
  }
}

void check_plan(const Plan& plan) {
  check_inside(plan);
  const std::vector<Shape> shapes = shapes_of(plan);
  check_valid(shapes);
  check_no_overlap(shapes);
  check_streets_free(plan, shapes);
  check_trees_outside(plan, shapes);
  for (const PlannedBuilding& building : plan.buildings) {
    if (!building.parts.empty()) {
      check_parts(building);
    }
  }
}

std::size_t with_courtyard(const Plan& plan) {
  return static_cast<std::size_t>(
      std::count_if(plan.buildings.begin(), plan.buildings.end(),
                    [](const PlannedBuilding& it) { return !it.footprint.courtyards.empty(); }));
}

bool same(const Plan& a, const Plan& b) {
  return std::equal(a.buildings.begin(), a.buildings.end(), b.buildings.begin(), b.buildings.end(),
                    [](const PlannedBuilding& one, const PlannedBuilding& other) {
                      return one.footprint.outer == other.footprint.outer &&
                             one.height_m == other.height_m;
                    }) &&
         std::equal(a.streets.begin(), a.streets.end(), b.streets.begin(), b.streets.end(),
                    [](const PlannedStreet& one, const PlannedStreet& other) {
                      return one.axis_m == other.axis_m && one.name == other.name;
                    });
}

}  // namespace

TEST_CASE("Old town: no two buildings overlap, no street or tree is built over") {
  const std::uint64_t seed = GENERATE(1U, 2U, 3U, 4U, 5U, 0xFFFF'FFFF'FFFF'FFFFU);
  CAPTURE(seed);

  check_plan(old_town({.size_m = 400.0}, seed));
}

TEST_CASE("Grid: no two buildings overlap, no street or tree is built over") {
  const std::uint64_t seed = GENERATE(1U, 2U, 3U, 4U, 5U, 0xFFFF'FFFF'FFFF'FFFFU);
  CAPTURE(seed);

  check_plan(grid({}, seed));
}

TEST_CASE("The smallest cities keep the rules too") {
  check_plan(old_town({.size_m = kSmallestCity_m}, 3));
  check_plan(grid({.size_m = kSmallestCity_m}, 3));
}

TEST_CASE("An old town has narrow streets, low houses, courtyards, squares and a church") {
  const Plan plan = old_town({}, 1);

  for (const PlannedStreet& street : plan.streets) {
    REQUIRE(street.width_m >= 2.5);
    REQUIRE(street.width_m <= 8.0);
  }
  std::size_t churches = 0;
  for (const PlannedBuilding& building : plan.buildings) {
    if (building.use == "church") {
      ++churches;
      REQUIRE(building.parts.size() == 2);
      REQUIRE(building.height_m > 30.0);
    } else {
      REQUIRE(building.height_m >= 10.0);
      REQUIRE(building.height_m <= 15.0);
    }
  }
  REQUIRE(churches == 1);
  // 13 x 13 fields of 46 m, some without a site, less the open places.
  REQUIRE(plan.buildings.size() > 140);
  REQUIRE(with_courtyard(plan) > 20);
  REQUIRE(plan.squares.size() == 2);
  REQUIRE(plan.trees.size() > 10);
  REQUIRE(plan.woods.size() == 1);
}

TEST_CASE("Most streets of an old town bend") {
  const Plan plan = old_town({}, 1);

  // A street that is straight is as long as its ends are apart.
  std::size_t bent = 0;
  std::size_t long_ones = 0;
  for (const PlannedStreet& street : plan.streets) {
    double length_m = 0.0;
    for (std::size_t i = 1; i < street.axis_m.size(); ++i) {
      length_m += (street.axis_m[i] - street.axis_m[i - 1]).norm();
    }
    if (street.axis_m.size() > 3 && street.highway != "residential") {
      ++long_ones;
      bent += (street.axis_m.back() - street.axis_m.front()).norm() < 0.99 * length_m ? 1U : 0U;
    }
  }
  REQUIRE(long_ones > 10);
  REQUIRE(static_cast<double>(bent) > 0.8 * static_cast<double>(long_ones));
}

TEST_CASE("A grid has wide streets and tall buildings, several to a block") {
  const Plan plan = grid({}, 1);

  // 600 m are four blocks of 150 m and eight of 75 m: 5 avenues, 9 streets.
  REQUIRE(plan.streets.size() == 14);
  for (const PlannedStreet& street : plan.streets) {
    const bool avenue = street.name.find("Avenue") != std::string::npos;
    REQUIRE(street.width_m >= (avenue ? 25.0 : 15.0));
    REQUIRE(street.width_m <= (avenue ? 30.0 : 18.0));
  }
  for (const PlannedBuilding& building : plan.buildings) {
    REQUIRE(building.height_m >= 50.0);
    REQUIRE(building.height_m <= 150.0);
  }
  // 31 blocks and a park; lots of at most 40 m beside streets of 120 m or more.
  REQUIRE(plan.buildings.size() > 31 * 3);
  REQUIRE(with_courtyard(plan) > 5);
  REQUIRE(std::count_if(plan.buildings.begin(), plan.buildings.end(),
                        [](const auto& it) { return it.parts.size() > 1; }) > 20);
}

TEST_CASE("A seed gives one city, another seed another one") {
  REQUIRE(same(old_town({}, 7), old_town({}, 7)));
  REQUIRE_FALSE(same(old_town({}, 7), old_town({}, 8)));
  REQUIRE(same(grid({}, 7), grid({}, 7)));
  REQUIRE_FALSE(same(grid({}, 7), grid({}, 8)));
}

TEST_CASE("A city without a possible size is refused with the range") {
  for (const double size_m : {0.0, -5.0, 199.9, 5000.1, std::nan("")}) {
    REQUIRE_THROWS_WITH(old_town({.size_m = size_m}, 1), Catch::Contains("200 m ... 5000 m"));
    REQUIRE_THROWS_WITH(grid({.size_m = size_m}, 1), Catch::Contains("200 m ... 5000 m"));
  }
}

TEST_CASE("Streets of a large old town have names of their own") {
  const auto names = old_street_names(700, 1);

  REQUIRE(std::set<std::string>(names.begin(), names.end()).size() == 700);
  REQUIRE(ordinal(1) == "1st");
  REQUIRE(ordinal(12) == "12th");
  REQUIRE(ordinal(22) == "22nd");
  REQUIRE(ordinal(113) == "113th");
}

}  // namespace cuscus::city::generate
