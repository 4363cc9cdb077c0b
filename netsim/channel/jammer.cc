#include "netsim/channel/jammer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cuscus::netsim {
namespace {

void require_jammer(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"jammer: " + rule};
  }
}

}  // namespace

Jammer::Jammer(const JammerParameters& parameters) : parameters_{parameters} {
  require_jammer(parameters.p_WJ.allFinite() && std::isfinite(parameters.power.value),
                 "position and power must be finite");
  require_jammer(parameters.band.centre_hz > 0.0 && parameters.band.width_hz > 0.0 &&
                     std::isfinite(parameters.band.centre_hz + parameters.band.width_hz),
                 "frequency and bandwidth must be above 0 Hz");
  require_jammer(parameters.duty > 0.0 && parameters.duty <= 1.0,
                 "the duty must be above 0 and at most 1");
  require_jammer(parameters.period >= std::chrono::microseconds{100} &&
                     parameters.period <= std::chrono::hours{24},
                 "the period must be 100 us to 24 h");
  require_jammer(
      parameters.start >= SimClock::duration::zero() && parameters.stop > parameters.start,
      "it must start at 0 s or later, and stop after its start");
  pulse_ = SimClock::duration{
      std::llround(static_cast<double>(parameters.period.count()) * parameters.duty)};
}

bool Jammer::on(SimTime time) const {
  const auto since_start = time.time_since_epoch() - parameters_.start;
  return since_start >= SimClock::duration::zero() && time.time_since_epoch() < parameters_.stop &&
         since_start % parameters_.period < pulse_;
}

std::optional<SimTime> Jammer::next_switch(SimTime time) const {
  const auto now = time.time_since_epoch();
  if (now < parameters_.start) {
    return SimTime{parameters_.start};
  }
  if (now >= parameters_.stop) {
    return std::nullopt;
  }
  auto next = parameters_.stop;
  if (pulse_ < parameters_.period) {
    const auto phase = (now - parameters_.start) % parameters_.period;
    next = std::min(next, now - phase + (phase < pulse_ ? pulse_ : parameters_.period));
  }
  return next == SimClock::duration::max() ? std::nullopt : std::optional{SimTime{next}};
}

DecibelMilliwatt Jammer::power_in(const Band& channel) const {
  const Band& own = parameters_.band;
  const double low_hz =
      std::max(own.centre_hz - own.width_hz / 2.0, channel.centre_hz - channel.width_hz / 2.0);
  const double high_hz =
      std::min(own.centre_hz + own.width_hz / 2.0, channel.centre_hz + channel.width_hz / 2.0);
  const double share = std::clamp((high_hz - low_hz) / own.width_hz, 0.0, 1.0);
  return parameters_.power + Decibel::from_ratio(share);
}

}  // namespace cuscus::netsim
