#include "uav-agent/app/beacon_schedule.h"

#include <algorithm>

namespace cuscus::agent {
namespace {

constexpr std::uint16_t kBeaconPurpose = 0x6201;
constexpr std::uint16_t kControlPurpose = 0x6202;
constexpr SimClock::duration kJitterMax = std::chrono::milliseconds{5};

SimClock::duration share(SimClock::duration whole, double part) {
  return SimClock::duration{static_cast<std::int64_t>(static_cast<double>(whole.count()) * part)};
}

}  // namespace

BeaconSchedule::BeaconSchedule(std::uint64_t seed, std::uint32_t node, SimClock::duration period)
    : stream_{seed, random::stream_id(kBeaconPurpose, node)},
      period_{period},
      phase_{share(period, stream_.uniform(0))},
      deadline_{instant(0)} {}

SimTime BeaconSchedule::instant(std::uint64_t index) const {
  const auto jitter = share(std::min(period_ / 20, kJitterMax), stream_.uniform(index + 1));
  return SimTime{phase_ + static_cast<std::int64_t>(index) * period_ + jitter};
}

void BeaconSchedule::advance(SimTime now) {
  // Straight to the period that `now` lies in: a pause may have skipped very many.
  const std::int64_t reached = (now.time_since_epoch() - phase_) / period_;
  index_ = std::max(index_ + 1, static_cast<std::uint64_t>(std::max<std::int64_t>(reached, 0)));
  while (due(now) && instant(index_) <= now) {
    ++index_;
  }
  deadline_ = instant(index_);
}

SimTime control_phase(std::uint64_t seed, std::uint32_t node, SimClock::duration period) {
  const random::CounterStream stream{seed, random::stream_id(kControlPurpose, node)};
  return SimTime{share(period, stream.uniform(0))};
}

}  // namespace cuscus::agent
