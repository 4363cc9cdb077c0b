#include "netsim/mac/backoff.h"

#include <algorithm>

namespace cuscus::netsim {

void Backoff::begin_at_once(SimTime now) {
  contending_ = true;
  at_once_ = true;
  slots_ = 0;
  not_before_ = now + access_.aifs;
}

void Backoff::begin(SimTime now, std::uint32_t slots) {
  contending_ = true;
  at_once_ = false;
  slots_ = slots;
  not_before_ = now;
}

void Backoff::end() {
  contending_ = false;
  at_once_ = false;
}

void Backoff::hold(SimTime now) { not_before_ = std::max(not_before_, now); }

void Backoff::count_down(SimTime now, SimTime idle_since, bool frame_waits) {
  if (!contending_ || at_once_) {
    return;
  }
  const SimTime begins = countdown_begins(idle_since);
  if (now <= begins) {
    return;
  }
  const auto elapsed = static_cast<std::uint64_t>((now - begins) / slot_);
  if (elapsed >= slots_) {
    slots_ = 0;
    contending_ = frame_waits;
  } else {
    slots_ -= static_cast<std::uint32_t>(elapsed);
  }
}

void Backoff::widen() { window_ = std::min(2 * window_ + 1, access_.cw_max); }

SimTime Backoff::countdown_begins(SimTime idle_since) const {
  return std::max(idle_since + access_.aifs, not_before_);
}

SimTime Backoff::access_time(SimTime idle_since) const {
  return countdown_begins(idle_since) + slot_ * slots_;
}

}  // namespace cuscus::netsim
