#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "common/units/sim_time.h"
#include "world/dynamics/plant.h"
#include "world/sensors/constellation.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

/// Standard deviations are of one satellite's range or range rate.
struct GnssParameters {
  SimClock::duration period{std::chrono::milliseconds{200}};
  double mask_rad{0.08726646259971647};  ///< Satellites lower than this are not used: 5 degrees.
  double drift_m{2.5};                   ///< Of the error that varies slowly.
  SimClock::duration correlation_time{std::chrono::seconds{100}};  ///< Of that.
  double noise_m{0.5};  ///< Of the error that is drawn anew in every reading, in an open sky.
  double rate_noise_mps{0.05};
};

/// What a receiver works out; east, north, up from the origin.
struct GnssFix {
  Eigen::Vector3d p_WB_m;
  Eigen::Vector3d v_WB_W_mps;
  double hdop;
  double vdop;
};

struct GnssSample {
  std::uint32_t in_view;   ///< Satellites above the mask.
  std::uint32_t received;  ///< Of these: whose signal arrives. All of them make the fix.
  std::optional<GnssFix> fix;
};

/// A receiver of satellite navigation, in a city that hides part of the sky.
///
/// A satellite above the mask is received unless a building or the ground is on the line to it, or
/// leaves take more than a receiver can do without (foliage_attenuation()). Four or more make a fix
/// (PositionSolution). Range k errs by c_k + w_k: c_k a Gauss-Markov process of first order,
///
///   c(t + T) = φ c(t) + σ sqrt(1 - φ²) n,  φ = exp(-T / τ),
///
/// for satellite, atmosphere and slow multipath, and w_k white, whose deviation grows by
/// 10^(A / 20) behind leaves that take A dB; range rates err by white noise. Those errors go
/// through the least squares solution, so that a fix jumps when a satellite comes or goes. All are
/// functions of (seed, node, satellite, reading).
///
/// The antenna is 10 cm above the vehicle's position and receives from all directions alike; the
/// fix is of the vehicle's position. No reflected signals: what is hidden is lost. Models and
/// figures: docs/models/gnss.md.
class Gnss {
 public:
  Gnss(std::uint64_t seed, std::uint32_t node, const GnssParameters& parameters,
       const Constellation& sky);

  /// Reading number `reading` at `time`, of a vehicle at `body`. Readings are made one after the
  /// other, from number 0 on: slow errors go on from the last.
  [[nodiscard]] GnssSample sample(const Surroundings& surroundings, const RigidBodyState& body,
                                  SimTime time, std::uint64_t reading);

 private:
  void drift(std::uint64_t reading);

  std::uint64_t seed_;
  std::uint32_t node_;
  GnssParameters parameters_;
  Constellation sky_;
  double persistence_;                         // φ
  std::array<double, kSatellites> drift_m_{};  // c
};

/// What leaves of this length take of a signal at 1575.42 MHz [dB]:
///
///   A = A_m (1 - exp(-d γ / A_m)),  γ = 0.26 dB/m, A_m = 28.2 dB.
///
/// Source: Recommendation ITU-R P.833-9, section 3, mixed forest, between its 0.949 and 1.852 GHz.
[[nodiscard]] double foliage_attenuation_db(double length_m);

/// What a receiver can lose: from 45 dB Hz in an open sky to 25 dB Hz, at which tracking ends.
/// Source: Kaplan and Hegarty (PositionSolution), 5.6 and 6.2: typical figures.
inline constexpr double kGnssMargin_db = 20.0;

}  // namespace cuscus::world
