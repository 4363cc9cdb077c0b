#include "uav-agent/flight/estimator.h"

#include <cmath>

namespace cuscus::flight {
namespace {

/// A longer step than this is a gap: what the vehicle did meanwhile is not known.
constexpr double kGap_s = 0.1;
/// Acceleration that may have acted in a gap [m/s^2].
constexpr double kGapAcceleration_mps2 = 5.0;
/// Velocity at the first reading: standing, within this [m/s].
constexpr double kInitialSpeed_mps = 1.0;
/// Older motion-capture readings than this are not worth an extrapolation.
constexpr double kAgeMax_s = 0.1;

Eigen::Quaterniond exponential(const Eigen::Vector3d& rotation_rad) {
  const double angle_rad = rotation_rad.norm();
  if (angle_rad < 1e-12) {
    return Eigen::Quaterniond::Identity();
  }
  return Eigen::Quaterniond{Eigen::AngleAxisd{angle_rad, rotation_rad / angle_rad}};
}

/// The rotation vector of `q`, the shorter way round.
Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd rotation{q.w() < 0.0 ? Eigen::Quaterniond{-q.coeffs()} : q};
  return rotation.angle() * rotation.axis();
}

}  // namespace

bool VehicleEstimate::is_finite() const {
  return p_WB_m.allFinite() && v_WB_mps.allFinite() && q_WB.coeffs().allFinite() &&
         angular_rate_B_radps.allFinite();
}

void Estimator::reset() {
  const Eigen::Vector3d bias = gyroscope_bias_radps_;
  *this = Estimator{parameters_};
  if (bias.allFinite()) {
    gyroscope_bias_radps_ = bias;
  }
}

void Estimator::propagate(double dt_s) {
  auto& e = estimate_;
  const Eigen::Vector3d rotation_rad = e.angular_rate_B_radps * dt_s;
  const Eigen::Quaterniond q_middle = e.q_WB * exponential(0.5 * rotation_rad);
  const Eigen::Vector3d a_W =
      q_middle * specific_force_B_mps2_ - Eigen::Vector3d{0.0, 0.0, parameters_.gravity_mps2};
  e.p_WB_m += e.v_WB_mps * dt_s + a_W * (0.5 * dt_s * dt_s);
  e.v_WB_mps += a_W * dt_s;
  e.q_WB = (e.q_WB * exponential(rotation_rad)).normalized();

  const double density = parameters_.acceleration_density;
  const double q = density * density;
  Eigen::Matrix2d transition;
  transition << 1.0, dt_s, 0.0, 1.0;
  Eigen::Matrix2d noise;
  noise << dt_s * dt_s * dt_s / 3.0, dt_s * dt_s / 2.0, dt_s * dt_s / 2.0, dt_s;
  covariance_ = transition * covariance_ * transition.transpose() + q * noise;
}

Estimator::Intake Estimator::update(const ImuReading& reading) {
  if (!reading.angular_rate_B_radps.allFinite() || !reading.specific_force_B_mps2.allFinite()) {
    return Intake::kNotFinite;
  }
  if (last_imu_ && reading.time <= *last_imu_) {
    return Intake::kRepeated;
  }
  const Eigen::Vector3d rate = reading.angular_rate_B_radps - gyroscope_bias_radps_;
  const bool first = !last_imu_;
  last_imu_ = reading.time;
  const double dt_s = to_seconds(reading.time - estimate_.time);
  if (last_motion_capture_ && dt_s > kGap_s) {
    const double speed_mps = kGapAcceleration_mps2 * dt_s;
    covariance_(0, 0) += speed_mps * speed_mps * dt_s * dt_s;
    covariance_(1, 1) += speed_mps * speed_mps;
    attitude_lost_ = true;
  } else if (last_motion_capture_ && dt_s > 0.0) {
    // The mean of both ends of the step; a first reading has no other end.
    const Eigen::Vector3d force = reading.specific_force_B_mps2;
    estimate_.angular_rate_B_radps =
        first ? rate : Eigen::Vector3d{0.5 * (estimate_.angular_rate_B_radps + rate)};
    specific_force_B_mps2_ =
        first ? force : Eigen::Vector3d{0.5 * (specific_force_B_mps2_ + force)};
    propagate(dt_s);
  }
  if (reading.time > estimate_.time) {
    estimate_.time = reading.time;
  }
  estimate_.angular_rate_B_radps = rate;
  specific_force_B_mps2_ = reading.specific_force_B_mps2;
  return Intake::kUsed;
}

Estimator::Intake Estimator::update(const MotionCaptureReading& reading) {
  const double norm = reading.q_WB.norm();
  if (!reading.p_WB_m.allFinite() || !std::isfinite(norm) || norm < 0.5) {
    return Intake::kNotFinite;
  }
  if (last_motion_capture_ && reading.time <= *last_motion_capture_) {
    return Intake::kRepeated;
  }
  MotionCaptureReading unit = reading;
  unit.q_WB.normalize();
  if (!last_motion_capture_) {
    initialise(unit);
    return Intake::kUsed;
  }
  const double interval_s = to_seconds(reading.time - *last_motion_capture_);
  last_motion_capture_ = reading.time;
  if (!last_imu_ || reading.time - *last_imu_ > parameters_.imu_timeout) {
    // No IMU: rates from two attitudes, and no acceleration but what the corrections find.
    if (interval_s < kGap_s) {
      estimate_.angular_rate_B_radps =
          logarithm(last_measured_q_WB_.conjugate() * unit.q_WB) / interval_s;
    }
    specific_force_B_mps2_ =
        estimate_.q_WB.conjugate() * Eigen::Vector3d{0.0, 0.0, parameters_.gravity_mps2};
    if (const double dt_s = to_seconds(reading.time - estimate_.time); dt_s > 0.0) {
      propagate(dt_s);
      estimate_.time = reading.time;
    }
  }
  last_measured_q_WB_ = unit.q_WB;
  const double age_s = to_seconds(estimate_.time - reading.time);
  if (age_s < kAgeMax_s) {
    correct_position(unit, age_s);
    correct_attitude(unit, age_s, interval_s);
  }
  return Intake::kUsed;
}

void Estimator::initialise(const MotionCaptureReading& reading) {
  last_motion_capture_ = reading.time;
  last_measured_q_WB_ = reading.q_WB;
  estimate_.time = std::max(estimate_.time, reading.time);
  estimate_.p_WB_m = reading.p_WB_m;
  estimate_.v_WB_mps.setZero();
  estimate_.q_WB = reading.q_WB;
  attitude_lost_ = false;
  const double noise_m = parameters_.position_noise_m;
  covariance_ << noise_m * noise_m, 0.0, 0.0, kInitialSpeed_mps * kInitialSpeed_mps;
}

void Estimator::correct_position(const MotionCaptureReading& reading, double age_s) {
  auto& e = estimate_;
  const Eigen::Vector3d innovation = reading.p_WB_m - (e.p_WB_m - e.v_WB_mps * age_s);
  const double noise_m = parameters_.position_noise_m;
  const double variance = covariance_(0, 0) + noise_m * noise_m;
  const Eigen::Vector2d gain = covariance_.col(0) / variance;
  e.p_WB_m += gain(0) * innovation;
  e.v_WB_mps += gain(1) * innovation;
  covariance_ -= gain * covariance_.row(0).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

void Estimator::correct_attitude(const MotionCaptureReading& reading, double age_s,
                                 double interval_s) {
  auto& e = estimate_;
  const Eigen::Vector3d since_rad = e.angular_rate_B_radps * age_s;
  if (attitude_lost_) {
    e.q_WB = (reading.q_WB * exponential(since_rad)).normalized();
    attitude_lost_ = false;
    return;
  }
  const Eigen::Quaterniond predicted = e.q_WB * exponential(-since_rad);
  const Eigen::Vector3d difference_rad = logarithm(predicted.conjugate() * reading.q_WB);
  e.q_WB = (e.q_WB * exponential(parameters_.attitude_gain * difference_rad)).normalized();
  if (interval_s < kGap_s) {
    gyroscope_bias_radps_ -= parameters_.gyroscope_bias_gain_ps2 * interval_s * difference_rad;
  }
}

}  // namespace cuscus::flight
