#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "common/random/counter_stream.h"

namespace cuscus::world {

/// Standard deviations of the white noise of each reading, per axis.
struct MotionCaptureNoise {
  double position_m;
  double attitude_rad;
};

/// What a motion-capture system measures of one body.
struct MotionCaptureSample {
  Eigen::Vector3d p_WB_m;
  Eigen::Quaterniond q_WB;  ///< Unit.
};

/// The motion-capture system's view of one node, such as the paper's Optitrack: truth plus white
/// noise that is a function of (seed, node, reading). The attitude errs by a small rotation
/// vector in the body frame. No latency, loss or occlusion.
class MotionCapture {
 public:
  MotionCapture(std::uint64_t seed, std::uint32_t node, const MotionCaptureNoise& noise);

  /// Reading number `reading` of the run, when the truth is `truth`.
  [[nodiscard]] MotionCaptureSample sample(const MotionCaptureSample& truth,
                                           std::uint64_t reading) const;

 private:
  random::CounterStream position_;
  random::CounterStream attitude_;
  MotionCaptureNoise noise_;
};

}  // namespace cuscus::world
