#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/units/autopilot_limits.h"
#include "common/units/sim_time.h"
#include "uav-agent/flight/airframe.h"
#include "uav-agent/flight/cascade.h"
#include "uav-agent/flight/estimator.h"
#include "uav-agent/flight/trapezoid_profile.h"

namespace cuscus::flight {

enum class FlightState : std::uint8_t { kStopped, kTakingOff, kFlying, kLanding, kFailsafe };

/// "stopped", "taking-off", "flying", "landing", "failsafe".
[[nodiscard]] std::string_view name(FlightState state);

/// Why a vehicle went into failsafe.
enum class FailsafeReason : std::uint8_t {
  kNone,
  kMotionCaptureLost,
  kImuLost,
  kNotFinite,  ///< A NaN or an infinity in a reading, an estimate, a set-point or a command.
  kTiltBeyondLimit,
  kNoLiftOff,  ///< The take-off ramp reached its end on the ground.
};

/// Such as "motion capture lost"; empty for kNone.
[[nodiscard]] std::string_view name(FailsafeReason reason);

struct AutopilotParameters {
  EstimatorParameters estimator;
  CascadeGains gains;
  SimClock::duration motion_capture_timeout = kMotionCaptureTimeout;
  SimClock::duration imu_timeout = kImuTimeout;
  double tilt_limit_rad = 1.05;          ///< 60 degrees.
  double climb_speed_mps = 2.0;          ///< FL-AIR: 0.5.
  double climb_acceleration_mps2 = 1.0;  ///< FL-AIR: 0.2.
  double ramp_start_share = 0.6;         ///< Of nominal hover thrust, at the take-off ramp's start.
  double ramp_mps3 = 3.0;                ///< Growth of thrust per mass on the ground.
  double ramp_limit_share = 2.2;
  double lift_off_height_m = 0.03;  ///< FL-AIR: the ramp ends here.
  double landing_speed_mps = 1.0;
  double touchdown_speed_mps = 0.4;  ///< Below touchdown_height_m above the ground.
  double touchdown_height_m = 1.5;
  double failsafe_descent_mps = 0.8;
  SimClock::duration contact_time = std::chrono::milliseconds{500};
};

/// The state machine that turns readings and set-points into motor commands.
///
///   stopped --take_off()--> taking off --at altitude--> flying --land()--> landing --contact-->
///   stopped taking off, flying, landing --a check fails--> failsafe (level, descend, motors off on
///   the ground)
///
/// Each control period: sense(), then a set-point may be worked out from estimate(), then act().
/// Failsafe is latched: only a new Autopilot flies again.
class Autopilot {
 public:
  explicit Autopilot(const Airframe& airframe, const AutopilotParameters& parameters = {});

  /// Takes off as soon as both sensors are there, to `altitude_m` (world z). Only from kStopped.
  void take_off(double altitude_m) { wanted_altitude_m_ = altitude_m; }
  /// From kTakingOff and kFlying.
  void land();

  /// Takes in what sensors say at `now`; nothing or an old reading is no news.
  void sense(SimTime now, const std::optional<ImuReading>& imu,
             const std::optional<MotionCaptureReading>& motion_capture);

  /// Commands for this period. While flying it follows `setpoint`; without one it holds the last.
  [[nodiscard]] MotorCommands act(SimTime now, const std::optional<Setpoint>& setpoint);

  [[nodiscard]] FlightState state() const { return state_; }
  [[nodiscard]] FailsafeReason failsafe_reason() const { return failsafe_reason_; }
  [[nodiscard]] bool motors_on() const { return motors_on_; }
  /// Meaningful once ready().
  [[nodiscard]] const VehicleEstimate& estimate() const { return estimator_.estimate(); }
  [[nodiscard]] bool ready() const { return estimator_.ready(); }
  /// Yaw at take-off [rad]; set-points usually keep it.
  [[nodiscard]] double heading_rad() const { return hold_.yaw_rad; }

 private:
  void fail(FailsafeReason reason, SimTime now);
  void check(SimTime now);
  void begin_take_off(SimTime now);
  [[nodiscard]] MotorCommands ramp_up(SimTime now, double dt_s);
  [[nodiscard]] MotorCommands climb(SimTime now, double dt_s);
  [[nodiscard]] MotorCommands descend(SimTime now, double dt_s);
  [[nodiscard]] MotorCommands fall_gently(SimTime now);
  [[nodiscard]] bool in_contact(SimTime now, bool descending);
  [[nodiscard]] double height_m() const { return estimate().p_WB_m.z() - ground_m_; }
  void stop_motors();

  Airframe airframe_;
  AutopilotParameters parameters_;
  Estimator estimator_;
  Cascade cascade_;
  FlightState state_ = FlightState::kStopped;
  FailsafeReason failsafe_reason_ = FailsafeReason::kNone;
  std::optional<double> wanted_altitude_m_;
  std::optional<TrapezoidProfile> climb_;  ///< Nothing during the ramp on the ground.
  SimTime climb_began_;
  double ramp_mps2_ = 0.0;
  double ground_m_ = 0.0;
  Setpoint hold_;
  bool motors_on_ = false;
  std::optional<SimTime> last_act_;
  std::optional<SimTime> contact_since_;
  SimTime failsafe_deadline_;
  double failsafe_depth_m_ = 0.0;  ///< Below the ground, by dead reckoning: it stands there.
};

}  // namespace cuscus::flight
