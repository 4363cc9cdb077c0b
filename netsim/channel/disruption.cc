#include "netsim/channel/disruption.h"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/random/counter_stream.h"

namespace cuscus::netsim {
namespace {

/// Purpose number of the stream of phases (see random::stream_id).
constexpr std::uint16_t kDisruptionStream = 0x1030;

void require_disruption(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"disruption: " + rule};
  }
}

SimClock::duration share(SimClock::duration whole, double ratio) {
  return SimClock::duration{std::llround(static_cast<double>(whole.count()) * ratio)};
}

}  // namespace

Disruption::Disruption(const DisruptionParameters& parameters) : parameters_{parameters} {
  require_disruption(parameters.fraction > 0.0 && parameters.fraction <= 1.0,
                     "the fraction must be above 0 and at most 1");
  require_disruption(parameters.interval >= std::chrono::milliseconds{1},
                     "the interval must be at least 1 ms");
  require_disruption(
      parameters.offset >= SimClock::duration::zero() && parameters.offset <= parameters.interval,
      "the offset must be within the interval");
  length_ = share(parameters.interval, parameters.fraction);
}

SimTime Disruption::stretch_begins(std::int64_t interval) const {
  const SimTime begins = SimTime{} + interval * parameters_.interval;
  if (parameters_.phase == DisruptionPhase::kFixed) {
    return begins + parameters_.offset;
  }
  const random::CounterStream stream{parameters_.seed, random::stream_id(kDisruptionStream, 0)};
  return begins + share(parameters_.interval - length_,
                        stream.uniform(static_cast<std::uint64_t>(interval)));
}

bool Disruption::overlaps(SimTime from, SimTime to) const {
  const std::int64_t last = to.time_since_epoch() / parameters_.interval;
  // With a fixed offset the stretch of the interval before can reach into this one.
  for (std::int64_t k = from.time_since_epoch() / parameters_.interval - 1; k <= last; ++k) {
    const SimTime begins = stretch_begins(k);
    if (begins <= to && from < begins + length_) {
      return true;
    }
  }
  return false;
}

}  // namespace cuscus::netsim
