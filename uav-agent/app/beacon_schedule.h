#pragma once

#include <cstdint>

#include "common/random/counter_stream.h"
#include "common/units/sim_time.h"

namespace cuscus::agent {

/// When a node sends its beacons: phase + k period + jitter_k. The phase is uniform in the period
/// and the jitter in a twentieth of it, at most 5 ms; both are functions of (seed, node), so that a
/// fleet does not send in step, in every run alike.
class BeaconSchedule {
 public:
  BeaconSchedule(std::uint64_t seed, std::uint32_t node, SimClock::duration period);

  /// When the next beacon is due.
  [[nodiscard]] SimTime deadline() const { return deadline_; }
  [[nodiscard]] bool due(SimTime now) const { return now >= deadline_; }
  /// Moves on to the first beacon after `now`; those missed meanwhile are not made up for.
  void advance(SimTime now);

 private:
  [[nodiscard]] SimTime instant(std::uint64_t index) const;

  random::CounterStream stream_;
  SimClock::duration period_;
  SimClock::duration phase_;
  std::uint64_t index_ = 0;
  SimTime deadline_;
};

/// Offset of a node's control loop in the control period, a function of (seed, node): agents on one
/// machine do not all wake at once.
[[nodiscard]] SimTime control_phase(std::uint64_t seed, std::uint32_t node,
                                    SimClock::duration period);

}  // namespace cuscus::agent
