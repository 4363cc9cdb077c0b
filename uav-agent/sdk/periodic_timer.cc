#include "uav-agent/sdk/periodic_timer.h"

#include <stdexcept>

namespace cuscus::sdk {

PeriodicTimer::PeriodicTimer(SimClock::duration period, SimTime first)
    : period_{period}, deadline_{first} {
  if (period <= SimClock::duration::zero()) {
    throw std::invalid_argument{"a timer's period must be positive"};
  }
}

std::uint64_t PeriodicTimer::advance(SimTime now) {
  if (!due(now)) {
    return 0;
  }
  const auto skipped = (now - deadline_) / period_;
  deadline_ += (skipped + 1) * period_;
  return static_cast<std::uint64_t>(skipped);
}

}  // namespace cuscus::sdk
