#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/units/decibel.h"
#include "common/units/sim_time.h"
#include "uav-agent/flight/readings.h"

namespace cuscus::sdk {

using flight::CameraPicture;
using flight::GnssFix;
using flight::GnssReading;
using flight::ImuReading;
using flight::LidarScan;
using flight::MotionCaptureReading;
using flight::MotorCommands;
using flight::UltrasonicReading;

/// The time of the run, and how to wait for an instant of it.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual SimTime now() const = 0;
  /// Returns at once when `instant` has passed.
  virtual void sleep_until(SimTime instant) const = 0;
};

/// The latest readings. All return nothing before the first one, and the same one again until
/// there is a newer: compare ImuReading::sequence. They never wait.
class Sensors {
 public:
  virtual ~Sensors() = default;
  [[nodiscard]] virtual std::optional<ImuReading> imu() const = 0;
  /// Of this vehicle.
  [[nodiscard]] virtual std::optional<MotionCaptureReading> motion_capture() const = 0;
  /// Nothing ever of a vehicle that has none; likewise what follows.
  [[nodiscard]] virtual std::optional<UltrasonicReading> ultrasonic() const { return {}; }
  [[nodiscard]] virtual std::optional<LidarScan> lidar() const { return {}; }
  [[nodiscard]] virtual std::optional<GnssReading> gnss() const { return {}; }
  [[nodiscard]] virtual std::optional<CameraPicture> camera() const { return {}; }
  /// Pictures that the camera has made: whether there is a newer one, without copying it.
  [[nodiscard]] virtual std::uint64_t camera_pictures() const { return 0; }
};

/// The motion-capture system's view of all vehicles, where there is one to listen to.
class FleetMotionCapture {
 public:
  virtual ~FleetMotionCapture() = default;
  /// `node` as the run numbers its nodes; nothing for one that is not seen.
  [[nodiscard]] virtual std::optional<MotionCaptureReading> motion_capture_of(
      std::uint32_t node) const = 0;
};

/// What a vehicle's radio knows of another one, from the frames that it has decoded.
struct Neighbour {
  std::uint32_t node{};  ///< As the run numbers its nodes.
  SimTime heard;         ///< When the latest frame was over.
  SimClock::duration age{};
  std::uint64_t frames{};       ///< So far.
  DecibelMilliwatt received{};  ///< RSSI of the latest.
  DecibelMilliwatt mean{};      ///< Weighs the latest by 1/8 and the mean before it by 7/8.
  Decibel snr{};                ///< Of the latest.
  std::uint32_t rate_kbps{};    ///< Of the latest.
};

/// The vehicle's radio. What it tells, a real one could tell too: it knows nobody whom it has not
/// heard.
class Radio {
 public:
  virtual ~Radio() = default;
  /// Everybody heard so far, by number; those that fell silent grow old.
  [[nodiscard]] virtual std::vector<Neighbour> neighbours() const = 0;
  /// How much weaker the latest frame of `node` could have been and still have been received:
  ///
  ///   LB(i, j) = Pr_j^i - RS_thr^i
  ///
  /// with Pr its received power and RS_thr this receiver's threshold. Nothing when `node` was never
  /// heard.
  ///
  /// Source: N. R. Zema et al., "The CUSCUS simulator for distributed networked control systems",
  /// Ad Hoc Networks 68 (2018), equation 11.
  [[nodiscard]] virtual std::optional<Decibel> link_budget(std::uint32_t node) const = 0;
};

/// The motors. A vehicle stops them by itself when commands stay away (FL-AIR: 100 ms), so that a
/// program sends one every control period.
class Actuators {
 public:
  virtual ~Actuators() = default;
  /// 0 ... 1 each; `now` is when they were worked out.
  virtual void set_motors(const MotorCommands& commands, SimTime now) = 0;
};

/// One vehicle, simulated or real: everything that a flying program needs besides its sockets,
/// which are the operating system's own.
class Vehicle {
 public:
  virtual ~Vehicle() = default;
  [[nodiscard]] virtual const Clock& clock() const = 0;
  [[nodiscard]] virtual const Sensors& sensors() const = 0;
  [[nodiscard]] virtual Actuators& actuators() = 0;
  [[nodiscard]] virtual const Radio& radio() const = 0;
  /// Null where the vehicle cannot see the rest of its fleet.
  [[nodiscard]] virtual const FleetMotionCapture* fleet() const = 0;
};

}  // namespace cuscus::sdk
