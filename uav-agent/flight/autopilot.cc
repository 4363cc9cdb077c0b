#include "uav-agent/flight/autopilot.h"

#include <algorithm>
#include <cmath>

namespace cuscus::flight {
namespace {

/// A control period longer than this was a pause of the process.
constexpr double kPeriodMax_s = 0.1;
/// How far the altitude reference runs ahead of a vehicle that no longer sinks.
constexpr double kContactLead_m = 0.3;
constexpr double kContactSpeed_mps = 0.12;
/// A height known from the IMU alone that is this far below the ground, or this share of the height
/// at which failsafe began, means that the vehicle stands on it.
constexpr double kBlindDepth_m = 1.0;
constexpr double kBlindDepthShare = 0.1;
/// Vertical acceleration per velocity error in failsafe [1/s].
constexpr double kFailsafeGain_ps = 2.0;

SimClock::duration seconds(double s) {
  return std::chrono::duration_cast<SimClock::duration>(std::chrono::duration<double>{s});
}

bool finite(const MotorCommands& commands) {
  return std::all_of(commands.begin(), commands.end(), [](double c) { return std::isfinite(c); });
}

}  // namespace

std::string_view name(FlightState state) {
  switch (state) {
    case FlightState::kStopped:
      return "stopped";
    case FlightState::kTakingOff:
      return "taking-off";
    case FlightState::kFlying:
      return "flying";
    case FlightState::kLanding:
      return "landing";
    case FlightState::kFailsafe:
      return "failsafe";
  }
  return "unknown";
}

std::string_view name(FailsafeReason reason) {
  switch (reason) {
    case FailsafeReason::kNone:
      return "";
    case FailsafeReason::kMotionCaptureLost:
      return "motion capture lost";
    case FailsafeReason::kImuLost:
      return "imu lost";
    case FailsafeReason::kNotFinite:
      return "not a finite number";
    case FailsafeReason::kTiltBeyondLimit:
      return "tilt beyond limit";
    case FailsafeReason::kNoLiftOff:
      return "no lift-off";
  }
  return "unknown";
}

Autopilot::Autopilot(const Airframe& airframe, const AutopilotParameters& parameters)
    : airframe_{airframe},
      parameters_{parameters},
      estimator_{parameters.estimator},
      cascade_{airframe, parameters.gains} {}

void Autopilot::land() {
  if (state_ == FlightState::kTakingOff || state_ == FlightState::kFlying) {
    hold_.p_WB_m = estimate().p_WB_m;
    hold_.v_WB_mps.setZero();
    hold_.a_WB_mps2.setZero();
    contact_since_.reset();
    state_ = FlightState::kLanding;
  }
}

void Autopilot::sense(SimTime now, const std::optional<ImuReading>& imu,
                      const std::optional<MotionCaptureReading>& motion_capture) {
  using Intake = Estimator::Intake;
  const bool bad_imu = imu && estimator_.update(*imu) == Intake::kNotFinite;
  const bool bad_capture =
      motion_capture && estimator_.update(*motion_capture) == Intake::kNotFinite;
  if (!estimate().is_finite()) {
    estimator_.reset();
    fail(FailsafeReason::kNotFinite, now);
  }
  if (bad_imu || bad_capture) {
    fail(FailsafeReason::kNotFinite, now);
  }
  check(now);
}

void Autopilot::check(SimTime now) {
  if (state_ == FlightState::kStopped || state_ == FlightState::kFailsafe || !ready()) {
    return;
  }
  if (now - *estimator_.last_motion_capture() > parameters_.motion_capture_timeout) {
    fail(FailsafeReason::kMotionCaptureLost, now);
  } else if (now - *estimator_.last_imu() > parameters_.imu_timeout) {
    fail(FailsafeReason::kImuLost, now);
  } else if (tilt(estimate().q_WB) > parameters_.tilt_limit_rad) {
    fail(FailsafeReason::kTiltBeyondLimit, now);
  }
}

void Autopilot::fail(FailsafeReason reason, SimTime now) {
  if (state_ == FlightState::kStopped || state_ == FlightState::kFailsafe) {
    return;
  }
  state_ = FlightState::kFailsafe;
  failsafe_reason_ = reason;
  contact_since_.reset();
  // The estimate may be what failed: its height is then no bound.
  const double height =
      ready() && std::isfinite(height_m()) ? std::clamp(height_m(), 0.0, 500.0) : 100.0;
  failsafe_depth_m_ = std::max(kBlindDepth_m, kBlindDepthShare * height);
  failsafe_deadline_ = now + seconds(5.0 + 2.0 * height / parameters_.failsafe_descent_mps);
}

void Autopilot::stop_motors() {
  motors_on_ = false;
  cascade_.set_hover_offset(0.0);
}

void Autopilot::begin_take_off(SimTime now) {
  hold_.p_WB_m = estimate().p_WB_m;
  hold_.v_WB_mps.setZero();
  hold_.a_WB_mps2.setZero();
  hold_.yaw_rad = euler_angles(estimate().q_WB).z();
  ground_m_ = estimate().p_WB_m.z();
  ramp_mps2_ = parameters_.ramp_start_share * airframe_.gravity_mps2;
  climb_.reset();
  climb_began_ = now;
  motors_on_ = true;
  state_ = FlightState::kTakingOff;
}

MotorCommands Autopilot::act(SimTime now, const std::optional<Setpoint>& setpoint) {
  const double dt_s = last_act_ ? std::clamp(to_seconds(now - *last_act_), 0.0, kPeriodMax_s) : 0.0;
  last_act_ = now;
  const bool fresh =
      ready() && now - *estimator_.last_motion_capture() <= parameters_.motion_capture_timeout &&
      now - *estimator_.last_imu() <= parameters_.imu_timeout;
  if (state_ == FlightState::kStopped && wanted_altitude_m_ && fresh) {
    begin_take_off(now);
  }
  if (setpoint && state_ == FlightState::kFlying) {
    if (setpoint->is_finite()) {
      hold_ = *setpoint;
    } else {
      fail(FailsafeReason::kNotFinite, now);
    }
  }
  MotorCommands commands{};
  switch (state_) {
    case FlightState::kStopped:
      break;
    case FlightState::kTakingOff:
      commands = climb_ ? climb(now, dt_s) : ramp_up(now, dt_s);
      break;
    case FlightState::kFlying:
      commands = cascade_.step(estimate(), hold_, dt_s);
      break;
    case FlightState::kLanding:
      commands = descend(now, dt_s);
      break;
    case FlightState::kFailsafe:
      commands = fall_gently(now);
      break;
  }
  if (!finite(commands)) {
    fail(FailsafeReason::kNotFinite, now);
    return {};
  }
  return commands;
}

MotorCommands Autopilot::ramp_up(SimTime now, double dt_s) {
  ramp_mps2_ += parameters_.ramp_mps3 * dt_s;
  if (ramp_mps2_ > parameters_.ramp_limit_share * airframe_.gravity_mps2) {
    fail(FailsafeReason::kNoLiftOff, now);
    stop_motors();
    return {};
  }
  if (height_m() > parameters_.lift_off_height_m) {
    // Since lift-off thrust has grown by r t while the speed became r t^2 / 2: hovering needs
    // sqrt(2 r v) less than what the ramp has reached.
    const double speed_mps = std::max(0.0, estimate().v_WB_mps.z());
    const double beyond_mps2 = std::sqrt(2.0 * parameters_.ramp_mps3 * speed_mps);
    cascade_.set_hover_offset(ramp_mps2_ - beyond_mps2 - airframe_.gravity_mps2);
    climb_.emplace(estimate().p_WB_m.z(), *wanted_altitude_m_, parameters_.climb_speed_mps,
                   parameters_.climb_acceleration_mps2);
    climb_began_ = now;
    return climb(now, dt_s);
  }
  return cascade_.step(estimate(),
                       AttitudeSetpoint{.yaw_rad = hold_.yaw_rad, .thrust_mps2 = ramp_mps2_});
}

MotorCommands Autopilot::climb(SimTime now, double dt_s) {
  const double elapsed_s = to_seconds(now - climb_began_);
  const ProfilePoint point = climb_->at(elapsed_s);
  hold_.p_WB_m.z() = point.position_m;
  hold_.v_WB_mps.z() = point.velocity_mps;
  hold_.a_WB_mps2.z() = point.acceleration_mps2;
  if (elapsed_s >= climb_->duration_s()) {
    state_ = FlightState::kFlying;
  }
  return cascade_.step(estimate(), hold_, dt_s);
}

bool Autopilot::in_contact(SimTime now, bool descending) {
  if (!descending || std::abs(estimate().v_WB_mps.z()) > kContactSpeed_mps) {
    contact_since_.reset();
    return false;
  }
  if (!contact_since_) {
    contact_since_ = now;
  }
  return now - *contact_since_ >= parameters_.contact_time;
}

MotorCommands Autopilot::descend(SimTime now, double dt_s) {
  const double speed_mps = height_m() < parameters_.touchdown_height_m
                               ? parameters_.touchdown_speed_mps
                               : parameters_.landing_speed_mps;
  const double lead_m = estimate().p_WB_m.z() - hold_.p_WB_m.z();
  if (in_contact(now, lead_m > kContactLead_m)) {
    stop_motors();
    wanted_altitude_m_.reset();
    state_ = FlightState::kStopped;
    return {};
  }
  hold_.p_WB_m.z() -= speed_mps * dt_s;
  hold_.v_WB_mps.z() = -speed_mps;
  return cascade_.step(estimate(), hold_, dt_s);
}

MotorCommands Autopilot::fall_gently(SimTime now) {
  const bool near_ground = !ready() || height_m() < parameters_.touchdown_height_m;
  const SimClock::duration blind = parameters_.motion_capture_timeout;
  const bool height_known = ready() && now - *estimator_.last_motion_capture() <= blind;
  // A touch-down that the IMU missed leaves a sink rate that is not there, and no contact to see.
  const bool below_ground = ready() && !height_known && height_m() < -failsafe_depth_m_;
  if (now >= failsafe_deadline_ || below_ground ||
      (ready() && in_contact(now, near_ground || !height_known))) {
    stop_motors();
  }
  if (!motors_on_ || !ready()) {
    return {};
  }
  const double sink_mps2 =
      kFailsafeGain_ps * (-parameters_.failsafe_descent_mps - estimate().v_WB_mps.z());
  const double yaw_rad = euler_angles(estimate().q_WB).z();
  return cascade_.step(estimate(), AttitudeSetpoint{.yaw_rad = yaw_rad,
                                                    .thrust_mps2 = airframe_.gravity_mps2 +
                                                                   cascade_.hover_offset_mps2() +
                                                                   saturated(sink_mps2, 3.0)});
}

}  // namespace cuscus::flight
