#include "netsim/mac/tdma.h"

#include <algorithm>
#include <cassert>

namespace cuscus::netsim {

Tdma::Tdma(std::uint32_t node, const MacParameters& parameters, MacHost& host)
    : node_{node}, parameters_{&parameters}, host_{&host} {
  const std::vector<std::int32_t>& frame = parameters.tdma.frame;
  for (std::size_t slot = 0; slot < frame.size(); ++slot) {
    if (frame[slot] == static_cast<std::int32_t>(node)) {
      own_slots_.push_back(static_cast<std::int64_t>(slot));
    }
  }
}

void Tdma::enqueue(SimTime now, const Msdu& msdu) {
  if (needed(msdu) > parameters_->tdma.slot) {
    host_->finished(node_, msdu, SendOutcome::kTooLong, 0);
    return;
  }
  if (queue_.size() >= parameters_->queue_frames) {
    host_->finished(node_, msdu, SendOutcome::kQueueFull, 0);
    return;
  }
  queue_.push_back(msdu);
  if (queue_.size() == 1) {
    schedule_access(now);
  }
}

bool Tdma::received(SimTime /*now*/, const MacFrame& frame, const Mode& /*mode*/) {
  return frame.receiver == kGroup || frame.receiver == static_cast<std::int32_t>(node_);
}

void Tdma::transmission_ended(SimTime now) {
  assert(sending_);
  sending_ = false;
  const Msdu done = queue_.front();
  queue_.pop_front();
  schedule_access(now);
  host_->finished(node_, done, SendOutcome::kSent, 1);
}

void Tdma::timer(SimTime now, MacTimer /*timer*/) {
  while (!queue_.empty() && now - queue_.front().queued_at > parameters_->queue_lifetime) {
    const Msdu expired = queue_.front();
    queue_.pop_front();
    host_->finished(node_, expired, SendOutcome::kLifetime, 0);
  }
  if (queue_.empty() || earliest_start(now, queue_.front()) > now) {
    schedule_access(now);
    return;
  }
  const Msdu& msdu = queue_.front();
  sending_ = true;
  host_->transmit(node_,
                  {.kind = MacFrame::Kind::kData,
                   .sender = node_,
                   .receiver = msdu.destination,
                   .frame = msdu.frame,
                   .sequence = ++sequence_},
                  mode_of(msdu), msdu.psdu_bytes);
}

const Mode& Tdma::mode_of(const Msdu& msdu) const {
  return msdu.destination == kGroup ? *parameters_->group_mode : *parameters_->data_mode;
}

Duration Tdma::needed(const Msdu& msdu) const {
  return airtime(mode_of(msdu), msdu.psdu_bytes) + parameters_->tdma.guard;
}

SimTime Tdma::earliest_start(SimTime now, const Msdu& msdu) const {
  if (own_slots_.empty()) {
    return SimTime::max();
  }
  const Duration slot = parameters_->tdma.slot;
  const auto slots = static_cast<std::int64_t>(parameters_->tdma.frame.size());
  const std::int64_t current = (now - SimTime{}) / slot;
  const std::int64_t place = current % slots;
  const auto at_or_after = std::lower_bound(own_slots_.begin(), own_slots_.end(), place);
  auto next = at_or_after;
  if (at_or_after != own_slots_.end() && *at_or_after == place) {
    if (now + needed(msdu) <= SimTime{} + (current + 1) * slot) {
      return now;
    }
    ++next;
  }
  const std::int64_t ahead =
      next == own_slots_.end() ? own_slots_.front() + slots - place : *next - place;
  return SimTime{} + (current + ahead) * slot;
}

/// The timer goes off when the front frame can be sent, or else when it has waited too long.
void Tdma::schedule_access(SimTime now) {
  if (queue_.empty() || sending_) {
    return;
  }
  const Msdu& front = queue_.front();
  const SimTime expiry = front.queued_at + parameters_->queue_lifetime + Duration{1};
  host_->set_timer(node_, MacTimer::kAccess,
                   std::max(now, std::min(earliest_start(now, front), expiry)));
}

}  // namespace cuscus::netsim
