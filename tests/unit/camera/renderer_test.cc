#include "camera/gl/renderer.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "camera/gl/surfaceless_context.h"

namespace cuscus::camera {
namespace {

using Eigen::Vector3d;

constexpr double kQuarter_rad = std::numbers::pi / 2.0;

/// A house of brick, not square, and not in the middle of anything.
const Vector3d kLow_m{40.0, -6.0, 0.0};
const Vector3d kHigh_m{58.0, 14.0, 22.0};

city::City one_house() {
  city::City city;
  city::Building building;
  building.outer_walls = city::Material::kBrick;
  building.prisms.push_back({.footprint = {.outer = {{kLow_m.x(), kLow_m.y()},
                                                     {kHigh_m.x(), kLow_m.y()},
                                                     {kHigh_m.x(), kHigh_m.y()},
                                                     {kLow_m.x(), kHigh_m.y()}},
                                           .courtyards = {}},
                             .bottom_m = kLow_m.z(),
                             .top_m = kHigh_m.z()});
  city.buildings.push_back(building);
  return city;
}

using Rgb = std::array<int, 3>;

/// What is seen: sky, ground, or a face of the house: 2 + 2 axis + (0 low, 1 high).
enum Seen : int { kSky = 0, kGround = 1, kFirstFace = 2 };

/// What a ray meets first, by slabs (A. Williams et al., "An efficient and robust ray-box
/// intersection algorithm", J. Graphics Tools 10, 2005): no part of what is tested.
int met(const Vector3d& from_m, const Vector3d& ray) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  int face = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double to_low = (kLow_m[axis] - from_m[axis]) / ray[axis];
    const double to_high = (kHigh_m[axis] - from_m[axis]) / ray[axis];
    if (std::min(to_low, to_high) > enter) {
      enter = std::min(to_low, to_high);
      face = kFirstFace + 2 * axis + (to_high < to_low ? 1 : 0);
    }
    leave = std::min(leave, std::max(to_low, to_high));
  }
  if (face >= 0 && enter < leave) {
    return face;
  }
  return ray.z() < 0.0 ? kGround : kSky;
}

/// A picture with what each of its pixels is.
class Picture {
 public:
  explicit Picture(const Pinhole& camera)
      : camera_{camera}, rgb_(std::size_t{3} * camera.width_px * camera.height_px) {}

  [[nodiscard]] std::span<std::byte> bytes() { return rgb_; }
  [[nodiscard]] int width() const { return static_cast<int>(camera_.width_px); }
  [[nodiscard]] int height() const { return static_cast<int>(camera_.height_px); }
  [[nodiscard]] Rgb at(int column, int row) const {
    const auto first = static_cast<std::size_t>(3 * (row * width() + column));
    return {std::to_integer<int>(rgb_[first]), std::to_integer<int>(rgb_[first + 1]),
            std::to_integer<int>(rgb_[first + 2])};
  }
  /// By colour: blue sky, red bricks, ground between them.
  [[nodiscard]] int kind_at(int column, int row) const {
    const Rgb rgb = at(column, row);
    if (rgb[2] > rgb[0]) {
      return kSky;
    }
    return rgb[0] * 10 > rgb[2] * 16 ? kFirstFace : kGround;
  }

 private:
  Pinhole camera_;
  std::vector<std::byte> rgb_;
};

Picture drawn(const city::City& city, const Pinhole& camera, const CameraPose& pose,
              std::span<const Body> bodies = {}) {
  // One for all, and to the end: Mesa unloads its driver with the last, and leak checkers cannot
  // tell any more what the driver still holds.
  static const auto* const context = new SurfacelessContext;
  REQUIRE_FALSE(context->renderer().empty());
  Renderer renderer{scene_of(city)};
  Picture picture{camera};
  renderer.draw(camera, pose, bodies, picture.bytes());
  return picture;
}

/// What is expected in the middle of a pixel.
int expected_at(const Pinhole& camera, const CameraPose& pose, int column, int row) {
  const Vector3d ray_C{(column + 0.5 - camera.width_px / 2.0) / camera.focal_px(),
                       (row + 0.5 - camera.height_px / 2.0) / camera.focal_px(), 1.0};
  return met(pose.p_WC_m, pose.R_WC * ray_C);
}

/// What all pixels up to one away are expected to be; nothing across an edge.
std::optional<int> expected_around(const Pinhole& camera, const CameraPose& pose, int column,
                                   int row) {
  const int middle = expected_at(camera, pose, column, row);
  for (int down = -1; down <= 1; ++down) {
    for (int right = -1; right <= 1; ++right) {
      if (expected_at(camera, pose, column + right, row + down) != middle) {
        return std::nullopt;
      }
    }
  }
  return middle;
}

bool alike(const Rgb& one, const Rgb& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(one[i] - other[i]) > 2) {
      return false;
    }
  }
  return true;
}

/// Every pixel that is more than one away from each edge of the scene shows what is there, and
/// every face has a colour of its own. Gives how many pixels show what.
std::map<int, int> check_picture(const CameraPose& pose) {
  const Pinhole camera{};
  const Picture picture = drawn(one_house(), camera, pose);
  std::map<int, int> counts;
  std::map<int, Rgb> colours;
  int wrong = 0;
  for (int row = 0; row < picture.height(); ++row) {
    for (int column = 0; column < picture.width(); ++column) {
      const auto expected = expected_around(camera, pose, column, row);
      if (!expected) {
        continue;
      }
      ++counts[*expected];
      wrong += picture.kind_at(column, row) != std::min(*expected, int{kFirstFace}) ? 1 : 0;
      if (*expected >= kFirstFace) {
        const Rgb first = colours.try_emplace(*expected, picture.at(column, row)).first->second;
        wrong += alike(first, picture.at(column, row)) ? 0 : 1;
      }
    }
  }
  CHECK(wrong == 0);
  for (auto one = colours.begin(); one != colours.end(); ++one) {
    for (auto other = std::next(one); other != colours.end(); ++other) {
      CHECK_FALSE(alike(one->second, other->second));
    }
  }
  return counts;
}

Eigen::Quaterniond attitude(double yaw_rad, double pitch_rad, double roll_rad) {
  return Eigen::AngleAxisd{yaw_rad, Vector3d::UnitZ()} *
         Eigen::AngleAxisd{pitch_rad, Vector3d::UnitY()} *
         Eigen::AngleAxisd{roll_rad, Vector3d::UnitX()};
}

constexpr int kWest = kFirstFace;
constexpr int kNorth = kFirstFace + 3;
constexpr int kSouth = kFirstFace + 2;
constexpr int kRoof = kFirstFace + 5;

TEST_CASE("a level camera ahead shows house and horizon where they are") {
  auto counts = check_picture(CameraPose::of({0.0, -12.0, 9.0}, attitude(0.1, 0.0, 0.0), {}));

  CHECK(counts[kSky] > 10'000);
  CHECK(counts[kGround] > 10'000);
  CHECK(counts[kWest] > 5'000);
  CHECK(counts[kSouth] > 500);
}

TEST_CASE("a tilted camera ahead shows house and horizon where they are") {
  auto counts = check_picture(CameraPose::of({-5.0, 40.0, 34.0}, attitude(-0.65, 0.2, 0.35), {}));

  CHECK(counts[kSky] > 5'000);
  CHECK(counts[kGround] > 10'000);
  CHECK(counts[kWest] > 500);
  CHECK(counts[kNorth] > 500);
  CHECK(counts[kRoof] > 500);
}

TEST_CASE("a camera that looks down shows the house below where it is") {
  const CameraMount down{.p_BC_m = {0.1, 0.0, -0.05}, .pitch_rad = kQuarter_rad};

  auto level = check_picture(CameraPose::of({36.0, 8.0, 50.0}, attitude(2.3, 0.0, 0.0), down));
  CHECK(level[kRoof] > 5'000);
  CHECK(level[kWest] > 100);
  CHECK(level[kSky] == 0);

  auto tilted = check_picture(CameraPose::of({38.0, 20.0, 45.0}, attitude(-1.1, -0.25, 0.3), down));
  CHECK(tilted[kRoof] > 500);
  CHECK(tilted[kGround] > 5'000);
}

TEST_CASE("a larger picture of a wide field shows the same") {
  const Pinhole camera{.width_px = 641, .height_px = 480, .field_rad = kQuarter_rad};
  const auto pose = CameraPose::of({0.0, 0.0, 10.0}, Eigen::Quaterniond::Identity(), {});

  const Picture picture = drawn(one_house(), camera, pose);

  // The wall's upper edge in the middle column: f = 320.5, 240 - 320.5 * 12/40 = 143.85.
  CHECK(picture.kind_at(320, 142) == kSky);
  CHECK(picture.kind_at(320, 145) == kFirstFace);
  // Its northern edge, 14 m to the left of ahead: 320.5 - 320.5 * 14/40 = 208.3.
  CHECK(picture.kind_at(207, 200) == kSky);
  CHECK(picture.kind_at(210, 200) == kFirstFace);
}

TEST_CASE("other vehicles are seen, unless a house hides them") {
  const Pinhole camera{};
  const auto pose = CameraPose::of({0.0, 4.0, 10.0}, Eigen::Quaterniond::Identity(), {});
  const std::array bodies{Body{.size_m = {0.6, 0.6, 0.12}, .p_WB_m = {6.0, 5.0, 11.0}},
                          Body{.size_m = {3.0, 3.0, 3.0}, .p_WB_m = {80.0, 4.0, 10.0}}};

  const Picture without = drawn(one_house(), camera, pose);
  const Picture with = drawn(one_house(), camera, pose, bodies);

  int changed = 0;
  int left = with.width();
  int right = 0;
  for (int row = 0; row < with.height(); ++row) {
    for (int column = 0; column < with.width(); ++column) {
      if (with.at(column, row) != without.at(column, row)) {
        ++changed;
        left = std::min(left, column);
        right = std::max(right, column);
      }
    }
  }
  // The near side is 5.7 m ahead and reaches from 0.7 m to 1.3 m on the left.
  const double f = camera.focal_px();
  CHECK(left == Approx(160.0 - f * 1.3 / 5.7).margin(1.0));
  CHECK(right + 1 == Approx(160.0 - f * 0.7 / 6.3).margin(1.0));
  CHECK(changed > 50);
  CHECK(changed < 400);
}

TEST_CASE("a terrain stands in the picture as high as it is") {
  city::City city;
  // A plateau 30 m high whose rim goes on for ever.
  city.terrain = city::Terrain{.south_west_m = {-100.0, -100.0},
                               .cell_m = 100.0,
                               .columns = 3,
                               .rows = 3,
                               .height_m = std::vector<float>(9, 30.0F)};
  const Pinhole camera{};
  const auto pose =
      CameraPose::of({0.0, 0.0, 32.0}, attitude(0.0, 0.0, 0.0), {.pitch_rad = kQuarter_rad / 3.0});

  const Picture picture = drawn(city, camera, pose);

  // Horizon: 120 - f tan(30 degrees) = -11.9: out of the picture.
  for (int row = 0; row < picture.height(); row += 10) {
    CHECK(picture.kind_at(160, row) == kGround);
  }
  const Picture level =
      drawn(city, camera, CameraPose::of({0.0, 0.0, 32.0}, attitude(0, 0, 0), {}));
  CHECK(level.kind_at(10, 118) == kSky);
  CHECK(level.kind_at(10, 121) == kGround);
}

}  // namespace
}  // namespace cuscus::camera
