#pragma once

#include <chrono>
#include <numbers>

#include "common/units/sim_time.h"

/// What our autopilot needs of a scenario. Here and not beside the control laws, so that a scenario
/// that cannot be flown is refused before anything takes off.
namespace cuscus {

/// The autopilot goes into failsafe when its newest motion-capture reading is older.
inline constexpr SimClock::duration kMotionCaptureTimeout = std::chrono::milliseconds{200};

/// The same of the IMU.
inline constexpr SimClock::duration kImuTimeout = std::chrono::milliseconds{100};

/// Most tilt that position control asks for [rad]; FL-AIR: "sat ref" 15 degrees.
inline constexpr double kTiltReferenceLimit_rad = 15.0 * std::numbers::pi / 180.0;

}  // namespace cuscus
