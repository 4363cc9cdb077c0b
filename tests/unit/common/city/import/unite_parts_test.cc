#include "common/city/import/unite_parts.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "common/city/import/footprints.h"

namespace cuscus::city {
namespace {

Footprint rectangle(double west, double south, double east, double north) {
  return {.outer = {{west, south}, {east, south}, {east, north}, {west, north}}, .courtyards = {}};
}

Prism prism(const Footprint& footprint, double bottom_m, double top_m) {
  return {.footprint = footprint, .bottom_m = bottom_m, .top_m = top_m};
}

double volume_m3(const std::vector<Prism>& prisms) {
  double sum = 0.0;
  for (const Prism& p : prisms) {
    sum += area_m2(p.footprint) * (p.top_m - p.bottom_m);
  }
  return sum;
}

double shared_volume_m3(const std::vector<Prism>& prisms) {
  double sum = 0.0;
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    for (std::size_t j = i + 1; j < prisms.size(); ++j) {
      const double height_m = std::min(prisms[i].top_m, prisms[j].top_m) -
                              std::max(prisms[i].bottom_m, prisms[j].bottom_m);
      if (height_m > 0.0) {
        sum += height_m * overlap_m2(prisms[i].footprint, prisms[j].footprint);
      }
    }
  }
  return sum;
}

TEST_CASE("a building without parts is its outline") {
  const auto united = unite_parts({prism(rectangle(0, 0, 10, 20), 0, 12)}, {});

  REQUIRE(united.prisms.size() == 1);
  CHECK(united.prisms[0].footprint.outer == rectangle(0, 0, 10, 20).outer);
  CHECK(united.prisms[0].top_m == 12.0);
}

TEST_CASE("a part replaces its outline, and the rest of the outline stays") {
  const auto united =
      unite_parts({prism(rectangle(0, 0, 20, 10), 0, 15)}, {prism(rectangle(0, 0, 5, 10), 0, 40)});

  // 50 m2 of 40 m, and 150 m2 of 15 m.
  CHECK(united.prisms.size() == 2);
  CHECK(volume_m3(united.prisms) == Approx(50.0 * 40.0 + 150.0 * 15.0));
  CHECK(shared_volume_m3(united.prisms) == Approx(0.0).margin(1e-6));
}

TEST_CASE("under a part that begins above the ground there is nothing of the outline") {
  const auto united = unite_parts({prism(rectangle(0, 0, 20, 10), 0, 30)},
                                  {prism(rectangle(0, 0, 20, 10), 20, 30)});

  CHECK(volume_m3(united.prisms) == Approx(200.0 * 10.0));
}

TEST_CASE("a tower on a podium is counted once, however the mapper drew it") {
  const Prism podium = prism(rectangle(0, 0, 20, 20), 0, 20);
  const double expected_m3 = 400.0 * 20.0 + 100.0 * 80.0;

  // From the ground, from the podium's roof, or from within the podium.
  const double tower_bottom_m = GENERATE(0.0, 20.0, 10.0);
  const auto united =
      unite_parts({}, {podium, prism(rectangle(5, 5, 15, 15), tower_bottom_m, 100)});

  CHECK(volume_m3(united.prisms) == Approx(expected_m3));
  CHECK(shared_volume_m3(united.prisms) == Approx(0.0).margin(1e-6));
}

TEST_CASE("a part within other parts is hidden, and a part drawn twice is there once") {
  const Prism part = prism(rectangle(0, 0, 10, 10), 0, 30);

  const auto united = unite_parts({}, {part, prism(rectangle(2, 2, 4, 4), 5, 30), part});

  CHECK(united.prisms.size() == 1);
  // The first of two alike has the place.
  CHECK(united.hidden_parts == std::vector<std::size_t>{2, 1});
}

TEST_CASE("slivers between hand-drawn edges are no walls") {
  // The part misses the outline's edge by 10 cm.
  const auto united = unite_parts({prism(rectangle(0, 0, 20, 10), 0, 100)},
                                  {prism(rectangle(0.1, 0.0, 20, 10), 0, 50)});

  REQUIRE(united.prisms.size() == 1);
  CHECK(united.prisms[0].top_m == 50.0);
}

TEST_CASE("parts that touch along an edge keep their corners") {
  const auto united = unite_parts(
      {}, {prism(rectangle(0, 0, 10, 10), 0, 30), prism(rectangle(10, 0, 20, 10), 0, 20)});

  REQUIRE(united.prisms.size() == 2);
  CHECK(united.prisms[0].footprint.outer == rectangle(0, 0, 10, 10).outer);
  CHECK(united.prisms[1].footprint.outer == rectangle(10, 0, 20, 10).outer);
}

TEST_CASE("a part in an outline's courtyard leaves the outline as it is") {
  Footprint outline = rectangle(0, 0, 30, 30);
  outline.courtyards.push_back({{10, 10}, {10, 20}, {20, 20}, {20, 10}});

  const auto united =
      unite_parts({prism(outline, 0, 15)}, {prism(rectangle(12, 12, 18, 18), 0, 5)});

  CHECK(volume_m3(united.prisms) == Approx(800.0 * 15.0 + 36.0 * 5.0));
  REQUIRE(united.prisms.size() == 2);
  CHECK(united.prisms[1].footprint.courtyards.size() == 1);
}

TEST_CASE("the volume of random parts is that of their union, counted cell by cell") {
  // On a lattice, so that cells of 1 m are wholly inside or outside.
  std::mt19937 draws{11};
  const auto below = [&](int bound) {
    return static_cast<double>(draws() % static_cast<unsigned>(bound));
  };
  constexpr int kSide = 12;
  for (int round = 0; round < 100; ++round) {
    std::vector<Prism> parts;
    for (int i = 0; i < 6; ++i) {
      const double west = below(8);
      const double south = below(8);
      const double bottom_m = below(6);
      parts.push_back(prism(rectangle(west, south, west + 1 + below(4), south + 1 + below(4)),
                            bottom_m, bottom_m + 1 + below(6)));
    }
    double expected_m3 = 0.0;
    for (int x = 0; x < kSide; ++x) {
      for (int y = 0; y < kSide; ++y) {
        for (int z = 0; z < kSide; ++z) {
          expected_m3 += std::ranges::any_of(parts, [&](const Prism& part) {
            const auto box = bounds_of(part.footprint);
            return box.contains(Eigen::Vector2d{x + 0.5, y + 0.5}) && part.bottom_m < z + 0.5 &&
                   part.top_m > z + 0.5;
          });
        }
      }
    }

    const auto united = unite_parts({}, parts);

    CAPTURE(round);
    CHECK(volume_m3(united.prisms) == Approx(expected_m3));
    CHECK(shared_volume_m3(united.prisms) == Approx(0.0).margin(1e-6));
  }
}

TEST_CASE("triangles that touch along a part of an edge share nothing") {
  // Boost.Geometry 1.74 has all of the second one within the first: their edges are 0.2 mm apart.
  const Footprint large{.outer = {{-27.8299, -11.0574}, {27.8299, -22.1149}, {27.8299, 33.1723}},
                        .courtyards = {}};
  const Footprint small{.outer = {{0.0, 11.0574}, {-27.8299, 22.1149}, {-9.2766, 3.6858}},
                        .courtyards = {}};

  CHECK(overlap_m2(small, large) < 0.01);
  CHECK(overlap_m2(large, small) < 0.01);
}

TEST_CASE("footprints come out open, without repeated corners, counter-clockwise") {
  Footprint drawn;
  drawn.outer = {{0, 0}, {0, 10}, {10, 10}, {10, 10}, {10, 0}, {0, 0}};  // clockwise, closed
  drawn.courtyards = {{{2, 2}, {4, 2}, {4, 4}, {2, 4}}, {{5, 5}, {6, 6}, {5, 5}}};

  const auto footprint = normalized(drawn);

  REQUIRE(footprint);
  CHECK(footprint->outer.size() == 4);
  CHECK(signed_area_m2(footprint->outer) == Approx(100.0));
  REQUIRE(footprint->courtyards.size() == 1);
  CHECK(signed_area_m2(footprint->courtyards[0]) == Approx(-4.0));
  CHECK(area_m2(*footprint) == Approx(96.0));
  CHECK_FALSE(normalized({.outer = {{0, 0}, {1, 0}, {2, 0}}, .courtyards = {}}));
}

}  // namespace
}  // namespace cuscus::city
