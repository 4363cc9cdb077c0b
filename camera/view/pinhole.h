#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace cuscus::camera {

/// A pinhole camera without distortion. In its own frame C, x to the right of the picture, y down
/// in it and z ahead, a point (x, y, z) with z > 0 is seen at
///
///   column = w/2 + f x/z,  row = h/2 + f y/z,  f = (w/2) / tan(field/2)
///
/// with the width w and height h of the picture, its horizontal field of view, and pixels counted
/// from its top left corner: the middle of the first pixel is (0.5, 0.5). Pixels are square.
///
/// Source: R. Hartley, A. Zisserman, "Multiple View Geometry in Computer Vision", 2nd ed., section
/// 6.1, with the principal point in the middle.
struct Pinhole {
  std::uint32_t width_px{320};
  std::uint32_t height_px{240};
  double field_rad{1.2217304763960306};  ///< Horizontal, 0 ... pi.

  [[nodiscard]] double focal_px() const;
  /// Column and row; nothing for what is not ahead.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_C_m) const;
  /// From C to clip space for a depth of near/z (OpenGL with depths from 0 to 1, near is 1):
  /// nothing is too far away, and depth is as fine far away as a float is near 0. Row 0 of the
  /// picture is row 0 of the window.
  [[nodiscard]] Eigen::Matrix4d clip_from_camera(double near_m) const;
};

/// Where a camera sits on its vehicle (body frame B: FLU), and where it looks: ahead, then turned
/// by roll, pitch and yaw as the body's attitude is, R = Rz(yaw) Ry(pitch) Rx(roll). A pitch of 90
/// degrees looks down, the picture's top ahead.
struct CameraMount {
  Eigen::Vector3d p_BC_m{0.0, 0.0, 0.0};
  double roll_rad{0.0};
  double pitch_rad{0.0};
  double yaw_rad{0.0};

  /// Rotation of the camera's frame in the body's.
  [[nodiscard]] Eigen::Matrix3d R_BC() const;
};

/// Where a camera is. World frame W: ENU.
struct CameraPose {
  Eigen::Vector3d p_WC_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d R_WC{Eigen::Matrix3d::Identity()};

  [[nodiscard]] static CameraPose of(const Eigen::Vector3d& p_WB_m, const Eigen::Quaterniond& q_WB,
                                     const CameraMount& mount);
  /// A point of the world as the camera has it.
  [[nodiscard]] Eigen::Vector3d in_camera(const Eigen::Vector3d& p_W_m) const {
    return R_WC.transpose() * (p_W_m - p_WC_m);
  }
};

}  // namespace cuscus::camera
