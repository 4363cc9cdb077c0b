#include "world/sensors/motion_capture.h"

#include "world/sensors/white_noise.h"

namespace cuscus::world {

MotionCapture::MotionCapture(std::uint64_t seed, std::uint32_t node,
                             const MotionCaptureNoise& noise)
    : position_{seed, random::stream_id(NoisePurpose::kMotionCapturePosition, node)},
      attitude_{seed, random::stream_id(NoisePurpose::kMotionCaptureAttitude, node)},
      noise_{noise} {}

MotionCaptureSample MotionCapture::sample(const MotionCaptureSample& truth,
                                          std::uint64_t reading) const {
  const Eigen::Vector3d turn_B_rad = noise_.attitude_rad * normal_vector(attitude_, reading);
  const double angle_rad = turn_B_rad.norm();
  Eigen::Quaterniond q_WB = truth.q_WB;
  if (angle_rad > 0.0) {
    q_WB = (q_WB * Eigen::AngleAxisd{angle_rad, turn_B_rad / angle_rad}).normalized();
  }
  return {.p_WB_m = truth.p_WB_m + noise_.position_m * normal_vector(position_, reading),
          .q_WB = q_WB};
}

}  // namespace cuscus::world
