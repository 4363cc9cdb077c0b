#include "camera/view/pinhole.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace cuscus::camera {
namespace {

using Eigen::Vector3d;

constexpr double kQuarter_rad = std::numbers::pi / 2.0;
/// A right angle is seen over 320 pixels: the focal length is 160 pixels.
constexpr Pinhole kWide{.width_px = 320, .height_px = 240, .field_rad = kQuarter_rad};

Eigen::Vector2d seen(const CameraPose& pose, const Vector3d& p_W_m) {
  return kWide.project(pose.in_camera(p_W_m)).value();
}

TEST_CASE("the focal length follows from width and horizontal field of view") {
  CHECK(kWide.focal_px() == Approx(160.0));
  // FL-AIR's camera: 160 / tan(35 degrees)
  CHECK(Pinhole{}.focal_px() == Approx(228.5037));
}

TEST_CASE("a camera that looks ahead has left on the left and up on top") {
  // Eastwards from 10 m above the origin.
  const auto pose = CameraPose::of({0.0, 0.0, 10.0}, Eigen::Quaterniond::Identity(), CameraMount{});

  CHECK(seen(pose, {50.0, 0.0, 10.0}).isApprox(Eigen::Vector2d{160.0, 120.0}));
  // North is on the left of who looks east: 160 * 10/50 pixels.
  CHECK(seen(pose, {50.0, 10.0, 10.0}).isApprox(Eigen::Vector2d{128.0, 120.0}));
  CHECK(seen(pose, {50.0, 0.0, 20.0}).isApprox(Eigen::Vector2d{160.0, 88.0}));
  CHECK_FALSE(kWide.project(pose.in_camera({-50.0, 0.0, 10.0})));
}

TEST_CASE("a camera that looks down has ahead on top and left on the left") {
  const CameraMount down{.p_BC_m = {0.0, 0.0, -1.0}, .pitch_rad = kQuarter_rad};
  const Eigen::Quaterniond north{
      Eigen::AngleAxisd{kQuarter_rad, Vector3d::UnitZ()}};  // the vehicle's nose

  const auto pose = CameraPose::of({0.0, 0.0, 21.0}, north, down);

  CHECK(pose.p_WC_m.isApprox(Vector3d{0.0, 0.0, 20.0}));
  CHECK(seen(pose, {0.0, 0.0, 0.0}).isApprox(Eigen::Vector2d{160.0, 120.0}));
  CHECK(seen(pose, {0.0, 5.0, 0.0}).isApprox(Eigen::Vector2d{160.0, 80.0}));    // ahead
  CHECK(seen(pose, {-5.0, 0.0, 0.0}).isApprox(Eigen::Vector2d{120.0, 120.0}));  // left: west
}

TEST_CASE("attitude and place on the vehicle move the picture as they should") {
  const double pitch_rad = std::atan(0.25);
  const Eigen::Quaterniond nose_down{Eigen::AngleAxisd{pitch_rad, Vector3d::UnitY()}};
  const CameraMount ahead{.p_BC_m = {1.0, 0.0, 0.0}};

  const auto pose = CameraPose::of({0.0, 0.0, 30.0}, nose_down, ahead);

  CHECK(pose.p_WC_m.isApprox(Vector3d{std::cos(pitch_rad), 0.0, 30.0 - std::sin(pitch_rad)}));
  // The horizon rises in the picture by f tan(pitch) = 160 / 4.
  const Vector3d far_away = pose.p_WC_m + Vector3d{1e6, 0.0, 0.0};
  CHECK(seen(pose, far_away).isApprox(Eigen::Vector2d{160.0, 80.0}));

  const Eigen::Quaterniond right_down{Eigen::AngleAxisd{kQuarter_rad / 2.0, Vector3d::UnitX()}};
  const auto rolled = CameraPose::of({0.0, 0.0, 30.0}, right_down, CameraMount{});
  // Level and to the left by 45 degrees: with the right side down, the left of the horizon sinks.
  const auto left = seen(rolled, {100.0, 50.0, 30.0});
  CHECK(left.x() < 160.0);
  CHECK(left.y() > 120.0);
}

TEST_CASE("clip space is the picture, near is 1 and far away is 0") {
  const Eigen::Matrix4d clip_from_camera = kWide.clip_from_camera(0.5);
  const Vector3d p_C_m{3.0, -2.0, 8.0};

  const Eigen::Vector4d clip = clip_from_camera * p_C_m.homogeneous();
  const Eigen::Vector3d window = clip.head<3>() / clip.w();

  const auto pixel = kWide.project(p_C_m).value();
  CHECK((window.x() + 1.0) / 2.0 * 320.0 == Approx(pixel.x()));
  CHECK((window.y() + 1.0) / 2.0 * 240.0 == Approx(pixel.y()));
  CHECK(window.z() == Approx(0.5 / 8.0));
}

}  // namespace
}  // namespace cuscus::camera
