#include "camera/scene/scene.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "camera/scene/frustum.h"
#include "camera/view/pinhole.h"

namespace cuscus::camera {
namespace {

city::Building house(double west_m, double south_m, double side_m, double top_m) {
  city::Building building;
  building.prisms.push_back({.footprint = {.outer = {{west_m, south_m},
                                                     {west_m + side_m, south_m},
                                                     {west_m + side_m, south_m + side_m},
                                                     {west_m, south_m + side_m}},
                                           .courtyards = {}},
                             .bottom_m = 0.0,
                             .top_m = top_m});
  return building;
}

Tile tile_around(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m) {
  return {.first_vertex = 0, .vertices = 3, .low_m = low_m, .high_m = high_m};
}

TEST_CASE("houses far apart lie in different tiles that hold them") {
  city::City city;
  city.buildings = {house(10.0, 10.0, 20.0, 15.0), house(1000.0, 10.0, 20.0, 30.0)};

  const Scene scene = scene_of(city);

  CHECK(scene.has_flat_ground);
  CHECK(scene.vertices.size() == 2U * 12 * 3);  // six sides of two triangles
  REQUIRE(scene.tiles.size() == 2);
  CHECK(scene.tiles[1].first_vertex == scene.tiles[0].vertices);
  CHECK(scene.tiles[0].high_m.isApprox(Eigen::Vector3d{30.0, 30.0, 15.0}));
  CHECK(scene.tiles[1].low_m.isApprox(Eigen::Vector3d{1000.0, 10.0, 0.0}));
}

TEST_CASE("normals point outwards") {
  city::City city;
  city.buildings = {house(-10.0, -10.0, 20.0, 15.0)};
  const Scene scene = scene_of(city);

  for (std::size_t i = 0; i < scene.vertices.size(); i += 3) {
    Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = scene.vertices[i + k].p_W_m;
      middle_m += Eigen::Vector3d{p[0], p[1], p[2]} / 3.0;
    }
    const auto& n = scene.vertices[i].normal;
    // The house's middle is (0, 0, 7.5).
    CHECK(Eigen::Vector3d{static_cast<double>(n[0]), static_cast<double>(n[1]),
                          static_cast<double>(n[2])}
              .dot(middle_m - Eigen::Vector3d{0.0, 0.0, 7.5}) > 0.0);
  }
}

TEST_CASE("terrain goes on beyond its rim as high as that") {
  city::City city;
  city.terrain = city::Terrain{.south_west_m = {0.0, 0.0},
                               .cell_m = 10.0,
                               .columns = 2,
                               .rows = 2,
                               .height_m = {1.0F, 2.0F, 3.0F, 4.0F}};

  const Scene scene = scene_of(city);

  CHECK_FALSE(scene.has_flat_ground);
  const auto far_north_east = std::ranges::find_if(scene.vertices, [](const Vertex& vertex) {
    return vertex.p_W_m[0] > 10'000.0F && vertex.p_W_m[1] > 10'000.0F;
  });
  REQUIRE(far_north_east != scene.vertices.end());
  CHECK(far_north_east->p_W_m[2] == 4.0F);
  CHECK(far_north_east->colour[3] == 255);
}

TEST_CASE("what is ahead may be seen, what is behind or beside is left out") {
  const Pinhole camera{};
  Eigen::Matrix4d camera_from_world = Eigen::Matrix4d::Identity();
  camera_from_world.topLeftCorner<3, 3>() = CameraMount{}.R_BC().transpose();  // looks east
  const Eigen::Matrix4d clip = camera.clip_from_camera(0.05) * camera_from_world;

  CHECK(may_be_seen(tile_around({10.0, -1.0, -1.0}, {12.0, 1.0, 1.0}), clip));
  CHECK(may_be_seen(tile_around({-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}), clip));  // all around it
  CHECK(may_be_seen(tile_around({5.0, -500.0, -1.0}, {6.0, 500.0, 1.0}), clip));
  CHECK_FALSE(may_be_seen(tile_around({-12.0, -1.0, -1.0}, {-10.0, 1.0, 1.0}), clip));
  CHECK_FALSE(may_be_seen(tile_around({10.0, 40.0, -1.0}, {12.0, 42.0, 1.0}), clip));
  CHECK_FALSE(may_be_seen(tile_around({10.0, -1.0, 20.0}, {12.0, 1.0, 30.0}), clip));
}

}  // namespace
}  // namespace cuscus::camera
