#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "common/units/decibel.h"
#include "common/units/sim_time.h"

namespace cuscus::netsim {

/// A stretch of spectrum.
struct Band {
  double centre_hz{2.437e9};
  double width_hz{20e6};
};

/// What a scenario says about a located source of noise.
struct JammerParameters {
  Eigen::Vector3d p_WJ{Eigen::Vector3d::Zero()};  ///< Where it stands, ENU [m].
  DecibelMilliwatt power{20.0};  ///< EIRP while it is on, all of its band together.
  Band band{};
  double duty{1.0};  ///< Of every period; 1: without a break.
  SimClock::duration period{std::chrono::milliseconds{10}};
  SimClock::duration start{0};                         ///< Of its first pulse.
  SimClock::duration stop{SimClock::duration::max()};  ///< Off from here on.
};

/// A source of white noise that is on during
///
///   [start + k T, start + k T + δ T)   for k = 0, 1, ..., until stop,
///
/// T the period and δ the duty. Its power is spread evenly over its band; a receiver's channel
/// takes the share of the band that the two have in common, as if both had upright sides.
///
/// A pure function of time. Departs from real jammers, which sweep, follow or answer. Checked in
/// jammer_test.cc and jamming_test.cc.
class Jammer final {
 public:
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit Jammer(const JammerParameters& parameters);

  /// Where it stands, ENU [m].
  [[nodiscard]] const Eigen::Vector3d& place() const { return parameters_.p_WJ; }
  [[nodiscard]] bool on(SimTime time) const;
  /// The first instant after `time` at which it goes on or off.
  [[nodiscard]] std::optional<SimTime> next_switch(SimTime time) const;
  /// Of its power, what is within `channel`; -inf dBm: nothing.
  [[nodiscard]] DecibelMilliwatt power_in(const Band& channel) const;

 private:
  JammerParameters parameters_;
  SimClock::duration pulse_;
};

}  // namespace cuscus::netsim
