#include "netsim/air/jamming.h"

#include <algorithm>
#include <cmath>

namespace cuscus::netsim {

Jamming::Jamming(const std::vector<JammerParameters>& jammers, const Band& band,
                 const Channel& channel, const Antenna* antenna, std::vector<Decibel> antenna_gains)
    : channel_{&channel},
      antenna_{antenna},
      antenna_gains_{std::move(antenna_gains)},
      received_mw_(antenna_gains_.size()) {
  auto number = static_cast<std::uint32_t>(antenna_gains_.size());
  for (const JammerParameters& parameters : jammers) {
    Source source{.jammer = Jammer{parameters}, .number = number++};
    source.power = source.jammer.power_in(band);
    source.steady_dbm.resize(antenna_gains_.size());
    if (std::isfinite(source.power.value)) {  // others are beside the channel
      sources_.push_back(std::move(source));
    }
  }
}

void Jamming::follow(Source& source, const Places& places) const {
  if (source.version == places.version) {
    return;
  }
  source.version = places.version;
  for (std::uint32_t node = 0; node < source.steady_dbm.size(); ++node) {
    const Eigen::Vector3d& p_WN = places.p_WN[node];
    const Link link = Link::between(node, p_WN, source.number, source.jammer.place());
    DecibelMilliwatt received = source.power + antenna_gains_[node] - channel_->static_loss(link);
    const Eigen::Vector3d direction_W = source.jammer.place() - p_WN;
    if (antenna_ != nullptr && !direction_W.isZero(0.0)) {
      received = received + antenna_->gain(places.q_WN.empty()
                                               ? direction_W
                                               : places.q_WN[node].conjugate() * direction_W);
    }
    source.steady_dbm[node] = received.value;
  }
}

std::span<const double> Jamming::received_mw(SimTime now, const Places& places) {
  std::fill(received_mw_.begin(), received_mw_.end(), 0.0);
  const auto nodes = static_cast<std::uint32_t>(received_mw_.size());
  for (Source& source : sources_) {
    if (!source.jammer.on(now)) {
      continue;
    }
    follow(source, places);
    const std::uint64_t draw = source.draws++;
    for (std::uint32_t node = 0; node < nodes; ++node) {
      DecibelMilliwatt received{source.steady_dbm[node]};
      if (channel_->varies_per_frame()) {
        const Link link =
            Link::between(node, places.p_WN[node], source.number, source.jammer.place());
        received =
            received - channel_->frame_loss(
                           {.link = link, .from_low = false, .transmission = draw, .time = now});
      }
      received_mw_[node] += received.milliwatts();
    }
  }
  return received_mw_;
}

std::optional<SimTime> Jamming::next_change(SimTime now) const {
  std::optional<SimTime> next;
  const auto take = [&next](SimTime time) { next = next ? std::min(*next, time) : time; };
  for (const Source& source : sources_) {
    if (const auto change = source.jammer.next_switch(now)) {
      take(*change);
    }
    if (source.jammer.on(now)) {
      take(SimTime{(now.time_since_epoch() / kUpdatePeriod + 1) * kUpdatePeriod});
    }
  }
  return next;
}

}  // namespace cuscus::netsim
