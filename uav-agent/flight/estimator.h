#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "uav-agent/flight/readings.h"

namespace cuscus::flight {

/// Where the vehicle is and how it moves. World frame W: ENU; body frame B: FLU.
struct VehicleEstimate {
  SimTime time;  ///< Of the newest reading in it.
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d angular_rate_B_radps = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_finite() const;
};

struct EstimatorParameters {
  double gravity_mps2 = 9.81;
  /// Spectral density of the acceleration that the IMU does not see [m/s^2 per sqrt(Hz)].
  double acceleration_density = 0.1;
  /// Standard deviation of a motion-capture position [m].
  double position_noise_m = 0.002;
  /// Share of the attitude difference that one motion-capture reading corrects, at 100 Hz 0.1 s.
  double attitude_gain = 0.1;
  /// Gyroscope bias per attitude difference and time [1/s^2].
  double gyroscope_bias_gain_ps2 = 1.0;
  /// Without an IMU reading for this long, angular rates come from motion capture.
  SimClock::duration imu_timeout = std::chrono::milliseconds{50};
};

/// Fuses an IMU (200 Hz, propagates) with motion capture (100 Hz, corrects).
///
/// Position and velocity: a Kalman filter per axis with the measured acceleration as input; the
/// three axes have the same noise and therefore share one 2 x 2 covariance. Attitude: the
/// gyroscope, less an estimated bias, corrected by a fixed share of the difference to motion
/// capture (complementary filter; R. Mahony, T. Hamel, J.-M. Pflimlin, "Nonlinear complementary
/// filters on the special orthogonal group", IEEE TAC 53(5), 2008, section IV, with the measured
/// attitude in place of vector measurements). A reading older than the estimate is compared with
/// the estimate extrapolated back to its time.
class Estimator {
 public:
  /// What became of a reading.
  enum class Intake {
    kUsed,
    kRepeated,   ///< Not newer than the last one of its kind.
    kNotFinite,  ///< Refused: it holds a NaN or an infinity, or its quaternion has no direction.
  };

  explicit Estimator(const EstimatorParameters& parameters) : parameters_{parameters} {}

  Intake update(const ImuReading& reading);
  Intake update(const MotionCaptureReading& reading);

  /// Forgets everything but the gyroscope bias.
  void reset();

  /// Both sensors have been heard.
  [[nodiscard]] bool ready() const { return last_motion_capture_ && last_imu_; }
  /// Meaningful once ready().
  [[nodiscard]] const VehicleEstimate& estimate() const { return estimate_; }
  [[nodiscard]] std::optional<SimTime> last_imu() const { return last_imu_; }
  [[nodiscard]] std::optional<SimTime> last_motion_capture() const { return last_motion_capture_; }

 private:
  void propagate(double dt_s);
  void initialise(const MotionCaptureReading& reading);
  void correct_position(const MotionCaptureReading& reading, double age_s);
  void correct_attitude(const MotionCaptureReading& reading, double age_s, double interval_s);

  EstimatorParameters parameters_;
  VehicleEstimate estimate_;
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Identity();  ///< Of (position, velocity).
  Eigen::Vector3d gyroscope_bias_radps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_mps2_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond last_measured_q_WB_ = Eigen::Quaterniond::Identity();
  bool attitude_lost_ = true;
  std::optional<SimTime> last_imu_;
  std::optional<SimTime> last_motion_capture_;
};

}  // namespace cuscus::flight
