#pragma once

#include <cstdint>

#include "common/units/sim_time.h"

namespace cuscus::sdk {

/// Absolute deadlines phase + k period: a late round does not shift those after it.
///
///   PeriodicTimer timer{5ms};
///   for (;;) { clock.sleep_until(timer.deadline()); timer.advance(clock.now()); ... }
class PeriodicTimer {
 public:
  /// `period` is positive; the first deadline is `first`.
  explicit PeriodicTimer(SimClock::duration period, SimTime first = SimTime{});

  [[nodiscard]] SimTime deadline() const { return deadline_; }
  [[nodiscard]] bool due(SimTime now) const { return now >= deadline_; }

  /// Moves on to the first deadline after `now` and returns how many were skipped on the way: 0 in
  /// a program that keeps up. Does nothing before the deadline.
  std::uint64_t advance(SimTime now);

  [[nodiscard]] SimClock::duration period() const { return period_; }

 private:
  SimClock::duration period_;
  SimTime deadline_;
};

}  // namespace cuscus::sdk
