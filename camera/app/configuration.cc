#include "camera/app/configuration.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace cuscus::camera {
namespace {

bool is_side(std::uint32_t side_px) {
  return side_px >= shm::kMinPictureSide_px && side_px <= shm::kMaxPictureSide_px;
}

bool is_finite(const proto::Vector3& vector) {
  return std::isfinite(vector.x()) && std::isfinite(vector.y()) && std::isfinite(vector.z());
}

void require(bool holds, const proto::CameraNode& camera, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument{"camera configuration: node " + std::to_string(camera.node()) +
                                " '" + camera.name() + "': " + what};
  }
}

}  // namespace

void check_configuration(const proto::CameraConfiguration& configuration) {
  for (const proto::CameraNode& camera : configuration.cameras()) {
    require(is_side(camera.width_px()) && is_side(camera.height_px()), camera,
            "a picture must have " + std::to_string(shm::kMinPictureSide_px) + " ... " +
                std::to_string(shm::kMaxPictureSide_px) + " pixels either way");
    require(camera.period_ns() > 0, camera, "period_ns must be above 0");
    require(camera.field_rad() > 0.0 && camera.field_rad() < std::numbers::pi, camera,
            "field_rad must be above 0 and below half a turn");
    require(is_finite(camera.p_bc_m()) && std::isfinite(camera.roll_rad()) &&
                std::isfinite(camera.pitch_rad()) && std::isfinite(camera.yaw_rad()),
            camera, "its place and direction must be finite");
  }
  for (const proto::CameraBody& body : configuration.bodies()) {
    if (!is_finite(body.size_m())) {
      throw std::invalid_argument{"camera configuration: the body of node " +
                                  std::to_string(body.node()) + " must be of finite size"};
    }
  }
}

Pinhole pinhole_of(const proto::CameraNode& camera) {
  return {.width_px = camera.width_px(),
          .height_px = camera.height_px(),
          .field_rad = camera.field_rad()};
}

CameraMount mount_of(const proto::CameraNode& camera) {
  return {.p_BC_m = {camera.p_bc_m().x(), camera.p_bc_m().y(), camera.p_bc_m().z()},
          .roll_rad = camera.roll_rad(),
          .pitch_rad = camera.pitch_rad(),
          .yaw_rad = camera.yaw_rad()};
}

shm::PictureShape shape_of(const Pinhole& camera) {
  return {
      .width_px = camera.width_px, .height_px = camera.height_px, .focal_px = camera.focal_px()};
}

}  // namespace cuscus::camera
