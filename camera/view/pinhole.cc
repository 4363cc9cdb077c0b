#include "camera/view/pinhole.h"

#include <cmath>

namespace cuscus::camera {

double Pinhole::focal_px() const { return width_px / 2.0 / std::tan(field_rad / 2.0); }

std::optional<Eigen::Vector2d> Pinhole::project(const Eigen::Vector3d& p_C_m) const {
  if (p_C_m.z() <= 0.0) {
    return std::nullopt;
  }
  return Eigen::Vector2d{width_px / 2.0, height_px / 2.0} +
         focal_px() * p_C_m.head<2>() / p_C_m.z();
}

Eigen::Matrix4d Pinhole::clip_from_camera(double near_m) const {
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2.0 * focal_px() / width_px;
  clip(1, 1) = 2.0 * focal_px() / height_px;
  clip(2, 3) = near_m;
  clip(3, 2) = 1.0;
  return clip;
}

Eigen::Matrix3d CameraMount::R_BC() const {
  Eigen::Matrix3d ahead;   // columns: the picture's right, its down, ahead
  ahead << 0.0, 0.0, 1.0,  //
      -1.0, 0.0, 0.0,      //
      0.0, -1.0, 0.0;
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()} *
                                  Eigen::AngleAxisd{pitch_rad, Eigen::Vector3d::UnitY()} *
                                  Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitX()})
                                     .toRotationMatrix();
  return turned * ahead;
}

CameraPose CameraPose::of(const Eigen::Vector3d& p_WB_m, const Eigen::Quaterniond& q_WB,
                          const CameraMount& mount) {
  return {.p_WC_m = p_WB_m + q_WB * mount.p_BC_m, .R_WC = q_WB.toRotationMatrix() * mount.R_BC()};
}

}  // namespace cuscus::camera
