#pragma once

#include <chrono>
#include <cstdint>

namespace cuscus {

/// The clock of a run. It is never asked for the time: SimTime is an argument.
struct SimClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<SimClock>;
  static constexpr bool is_steady = true;
};

/// An instant of a run: nanoseconds since it began.
using SimTime = SimClock::time_point;

/// The instant `nanoseconds` after the run began.
[[nodiscard]] constexpr SimTime sim_time(std::int64_t nanoseconds) {
  return SimTime{SimClock::duration{nanoseconds}};
}

/// Nanoseconds since the run began, for messages and shared memory.
[[nodiscard]] constexpr std::int64_t to_ns(SimTime time) { return time.time_since_epoch().count(); }

/// Seconds, for formulas and tables.
[[nodiscard]] constexpr double to_seconds(SimClock::duration duration) {
  return std::chrono::duration<double>{duration}.count();
}

}  // namespace cuscus
