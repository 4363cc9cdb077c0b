#include "netsim/mac/carrier_sense.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace cuscus::netsim {

CarrierSense::CarrierSense(const MacParameters& parameters)
    : parameters_{&parameters},
      idle_since_{SimTime{} - parameters.eifs},
      nav_until_{idle_since_},
      nav_without_rts_{idle_since_},
      eifs_until_{idle_since_} {}

void CarrierSense::medium_busy() {
  assert(!busy_);
  busy_ = true;
}

void CarrierSense::medium_idle(SimTime now) {
  assert(busy_);
  busy_ = false;
  idle_since_ = now;
  if (std::exchange(eifs_due_, false)) {
    eifs_until_ = now + parameters_->eifs - parameters_->difs;
  }
}

void CarrierSense::reception_failed(SimTime now) {
  eifs_due_ = busy_;
  if (!busy_) {
    eifs_until_ = now + parameters_->eifs - parameters_->difs;
  }
}

void CarrierSense::reception_succeeded(SimTime now) {
  eifs_due_ = false;
  eifs_until_ = std::min(eifs_until_, now);
}

bool CarrierSense::reserve(SimTime now, Duration duration, bool by_rts) {
  const SimTime until = now + duration;
  if (until <= nav_until_ || duration <= Duration::zero()) {
    return false;
  }
  if (by_rts) {
    nav_without_rts_ = nav_until_;
  }
  nav_until_ = until;
  return true;
}

void CarrierSense::take_back(SimTime now) {
  nav_until_ = std::min(nav_until_, std::max(nav_without_rts_, now));
}

SimTime CarrierSense::idle_since() const {
  return std::max({idle_since_, nav_until_, eifs_until_});
}

}  // namespace cuscus::netsim
