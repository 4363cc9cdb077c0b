#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/units/sim_time.h"

namespace cuscus::flight {

/// Gyroscope and accelerometer at one instant. Body frame B: FLU.
struct ImuReading {
  SimTime time;
  std::uint64_t sequence = 0;
  Eigen::Vector3d angular_rate_B_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_mps2 = Eigen::Vector3d::Zero();  ///< +g upwards at rest.
};

/// Where a motion-capture system saw a body. World frame W: ENU; body frame B: FLU.
struct MotionCaptureReading {
  SimTime time;
  std::uint64_t sequence = 0;
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

/// Distance to the nearest surface in the cone of an ultrasonic sensor.
struct UltrasonicReading {
  SimTime time;
  std::uint64_t sequence = 0;
  std::optional<double> distance_m;  ///< Nothing: no surface in range.
};

/// One scan of a lidar: rows of equal elevation, in each the same azimuths. Ray k of row r is in
/// the body B at azimuth first_azimuth_rad + k azimuth_step_rad, from ahead counter-clockwise, and
/// at elevations_rad[r] above its x-y plane; ranges_m[r * rays + k] is how far it got.
struct LidarScan {
  SimTime time;
  std::uint64_t sequence = 0;
  std::uint32_t rays = 0;  ///< Of one row.
  double first_azimuth_rad = 0.0;
  double azimuth_step_rad = 0.0;
  std::vector<float> elevations_rad;
  std::vector<float> ranges_m;  ///< Infinite: no surface in range.
};

/// What a receiver of satellite navigation has worked out. World frame W: ENU.
struct GnssFix {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  double latitude_deg = 0.0;  ///< WGS-84; the same position.
  double longitude_deg = 0.0;
  double height_m = 0.0;  ///< Above the ellipsoid.
  double hdop = 0.0;
  double vdop = 0.0;
};

struct GnssReading {
  SimTime time;
  std::uint64_t sequence = 0;
  std::uint32_t satellites_in_view = 0;   ///< Above the receiver's mask, hidden ones included.
  std::uint32_t satellites_received = 0;  ///< Of these; all of them make the fix.
  std::optional<GnssFix> fix;             ///< Nothing: too few, or in too bad a geometry.
};

/// One picture of a camera: RGB8, row by row from the top, rgb[3 * (row * width_px + column)] is
/// red. A point (x, y, z) of the camera's frame (right, down, ahead) is seen at column width_px/2 +
/// focal_px x/z and row height_px/2 + focal_px y/z from the top left corner.
struct CameraPicture {
  SimTime time;
  std::uint64_t sequence = 0;  ///< From 1; a number left out is a picture that was not made.
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  double focal_px = 0.0;
  std::vector<std::byte> rgb;
};

/// Commands of an X4's motors, 0 ... 1: front left, front right, rear left, rear right.
using MotorCommands = std::array<double, 4>;

}  // namespace cuscus::flight
