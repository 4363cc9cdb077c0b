#include "common/city/export/solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <utility>

#include "tests/unit/common/city/export/sample_city.h"

namespace cuscus::city {
namespace {

/// Every side of a triangle belongs to one other triangle too, which has it the other way round.
void check_closed(const SolidMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++sides[{t[i], t[(i + 1) % 3]}];
    }
  }
  for (const auto& [side, count] : sides) {
    REQUIRE(count == 1);
    REQUIRE(sides.count({side.second, side.first}) == 1);
  }
}

/// By Gauss' theorem; positive when triangles are seen counter-clockwise from outside.
double volume_m3(const SolidMesh& mesh) {
  double six_times = 0.0;
  for (const auto& t : mesh.triangles) {
    six_times += mesh.corners[t[0]].dot(mesh.corners[t[1]].cross(mesh.corners[t[2]]));
  }
  return six_times / 6.0;
}

}  // namespace

TEST_CASE("A building with a courtyard is a closed solid with the volume of its walls") {
  SolidMesh mesh;
  mesh.add_prism({square_ring(100.0, 50.0, 40.0), {square_courtyard(110.0, 60.0, 20.0)}}, 3.0,
                 13.0);

  check_closed(mesh);
  REQUIRE(volume_m3(mesh) == Approx((40.0 * 40.0 - 20.0 * 20.0) * 10.0));
}

TEST_CASE("A tree is closed, as high as it should be, and stands on its foot") {
  SolidMesh mesh;
  mesh.add_tree({.foot_m = {5.0, 6.0, 2.0}, .height_m = 9.0, .crown_radius_m = 2.5});

  check_closed(mesh);
  REQUIRE(volume_m3(mesh) > 0.0);
  double low_m = 1e9;
  double high_m = -1e9;
  for (const auto& corner : mesh.corners) {
    low_m = std::min(low_m, corner.z());
    high_m = std::max(high_m, corner.z());
  }
  REQUIRE(low_m == 2.0);
  REQUIRE(high_m == 11.0);
}

TEST_CASE("The ground is the city's rectangle, or its terrain") {
  City city = sample_city();
  SolidMesh flat;
  flat.add_ground(city);
  REQUIRE(flat.triangles.size() == 2);
  REQUIRE(flat.corners[2] == Eigen::Vector3d{100.0, 50.0, 0.0});

  city.terrain = Terrain{.south_west_m = {-10.0, -20.0},
                         .cell_m = 5.0,
                         .columns = 3,
                         .rows = 2,
                         .height_m = {0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F}};
  SolidMesh hills;
  hills.add_ground(city);
  REQUIRE(hills.triangles.size() == 4);  // two for each of 2 x 1 cells
  REQUIRE(hills.corners[5] == Eigen::Vector3d{0.0, -15.0, 5.0});
}

}  // namespace cuscus::city
