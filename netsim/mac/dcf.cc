#include "netsim/mac/dcf.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace cuscus::netsim {

MacParameters MacParameters::from(const Standard& standard, Duration slot,
                                  std::uint32_t data_rate_kbps, std::uint32_t group_rate_kbps,
                                  std::span<const std::uint32_t> basic_rates_kbps) {
  const Mode& data = standard.mode(data_rate_kbps);
  const Mode& group = standard.mode(group_rate_kbps);
  // The lowest control answer there is: that of the lowest mode (10.3.7, ACKTxTime).
  const Mode& lowest = control_answer(standard, standard.modes.front(), basic_rates_kbps);
  MacParameters parameters;
  parameters.slot = slot;
  parameters.sifs = standard.sifs;
  parameters.difs = standard.sifs + 2 * slot;
  parameters.eifs = standard.sifs + airtime(lowest, kAckBytes) + parameters.difs;
  parameters.ack_timeout = standard.sifs + slot + standard.receive_start_delay;
  parameters.cw_min = standard.cw_min;
  parameters.cw_max = standard.cw_max;
  parameters.data_mode = &data;
  parameters.group_mode = &group;
  parameters.ack_mode = &control_answer(standard, data, basic_rates_kbps);
  parameters.group_ack_mode = &control_answer(standard, group, basic_rates_kbps);
  return parameters;
}

Dcf::Dcf(std::uint32_t node, const MacParameters& parameters, MacHost& host,
         random::CounterStream backoffs)
    : node_{node},
      parameters_{&parameters},
      host_{&host},
      backoffs_{backoffs},
      cw_{parameters.cw_min},
      // The medium was idle before the run began.
      idle_since_{SimTime{} - parameters.eifs},
      nav_until_{idle_since_},
      eifs_until_{idle_since_} {}

void Dcf::enqueue(SimTime now, const Msdu& msdu) {
  if (queue_.size() >= parameters_->queue_frames) {
    host_->finished(node_, msdu, SendOutcome::kQueueFull, 0);
    return;
  }
  queue_.push_back(msdu);
  if (queue_.size() > 1) {
    return;
  }
  if (contending_ && !busy_ && sending_ == Sending::kNothing && access_time() <= now) {
    contending_ = false;  // a post-backoff that ran out unobserved
  }
  if (!contending_) {
    if (busy_ || now < nav_until_) {
      draw_backoff(now);
    } else {
      contending_ = true;
      immediate_ = true;
      slots_ = 0;
      not_before_ = now + parameters_->difs;
    }
  }
  schedule_access(now);
}

void Dcf::medium_busy(SimTime now) {
  assert(!busy_);
  count_down(now);
  busy_ = true;
  if (contending_ && immediate_) {
    draw_backoff(now);
  }
  schedule_access(now);
}

void Dcf::medium_idle(SimTime now) {
  assert(busy_);
  busy_ = false;
  idle_since_ = now;
  schedule_access(now);
}

void Dcf::reception_started(SimTime /*now*/) { receiving_ = true; }

void Dcf::reception_failed(SimTime now) {
  const bool was_receiving = std::exchange(receiving_, false);
  eifs_until_ = now + parameters_->eifs - parameters_->difs;
  // A header that failed is no PHY-RXSTART: the ACK may still come before the timeout.
  if (was_receiving && awaiting_ack_ && sending_ == Sending::kNothing) {
    ack_missing(now);
  }
  schedule_access(now);
}

bool Dcf::received(SimTime now, const MacFrame& frame, const Mode& mode) {
  receiving_ = false;
  eifs_until_ = std::min(eifs_until_, now);
  const bool mine = frame.receiver == static_cast<std::int32_t>(node_);
  if (!mine && frame.duration > Duration::zero()) {
    nav_until_ = std::max(nav_until_, now + frame.duration);
  }
  if (awaiting_ack_ && sending_ == Sending::kNothing) {
    if (mine && frame.kind == MacFrame::Kind::kAck) {
      complete(now, SendOutcome::kAcknowledged);
    } else {
      ack_missing(now);
    }
  }
  bool deliver = frame.kind == MacFrame::Kind::kData && frame.receiver == kGroup;
  if (mine && frame.kind == MacFrame::Kind::kData) {
    response_ = {.kind = MacFrame::Kind::kAck,
                 .sender = node_,
                 .receiver = static_cast<std::int32_t>(frame.sender)};
    response_mode_ =
        &mode == parameters_->data_mode ? parameters_->ack_mode : parameters_->group_ack_mode;
    response_due_ = true;
    host_->set_timer(node_, MacTimer::kResponse, now + parameters_->sifs);
    if (last_sequence_.size() <= frame.sender) {
      last_sequence_.resize(frame.sender + std::size_t{1}, 0);
    }
    deliver = last_sequence_[frame.sender] != frame.sequence;
    last_sequence_[frame.sender] = frame.sequence;
  }
  schedule_access(now);
  return deliver;
}

void Dcf::transmission_ended(SimTime now) {
  const Sending sent = sending_;
  sending_ = Sending::kNothing;
  idle_since_ = now;
  if (sent == Sending::kData) {
    if (queue_.front().destination == kGroup) {
      complete(now, SendOutcome::kSent);
    } else {
      awaiting_ack_ = true;
      host_->set_timer(node_, MacTimer::kAckTimeout, now + parameters_->ack_timeout);
    }
  }
  schedule_access(now);
}

void Dcf::timer(SimTime now, MacTimer timer) {
  switch (timer) {
    case MacTimer::kAccess:
      access_set_ = false;
      access(now);
      break;
    case MacTimer::kResponse:
      respond(now);
      break;
    case MacTimer::kAckTimeout:
      if (awaiting_ack_ && !receiving_) {  // else the reception that is under way decides
        ack_missing(now);
        schedule_access(now);
      }
      break;
  }
}

SimTime Dcf::countdown_begins() const {
  const SimTime idle = std::max({idle_since_, nav_until_, eifs_until_});
  return std::max(idle + parameters_->difs, not_before_);
}

SimTime Dcf::access_time() const { return countdown_begins() + parameters_->slot * slots_; }

/// Charges the idle time up to `now` against the backoff, before the medium becomes busy.
void Dcf::count_down(SimTime now) {
  if (!contending_ || immediate_ || busy_ || sending_ != Sending::kNothing) {
    return;
  }
  const SimTime begins = countdown_begins();
  if (now <= begins) {
    return;
  }
  const auto elapsed = static_cast<std::uint64_t>((now - begins) / parameters_->slot);
  if (elapsed >= slots_) {
    slots_ = 0;
    contending_ = !queue_.empty();  // without a frame it was a post-backoff, now over
  } else {
    slots_ -= static_cast<std::uint32_t>(elapsed);
  }
}

void Dcf::draw_backoff(SimTime now) {
  slots_ = backoffs_.below(draw_++, cw_ + 1);
  contending_ = true;
  immediate_ = false;
  not_before_ = now;
}

void Dcf::schedule_access(SimTime now) {
  const bool possible = contending_ && !queue_.empty() && !busy_ && !awaiting_ack_ &&
                        !response_due_ && sending_ == Sending::kNothing;
  if (possible) {
    host_->set_timer(node_, MacTimer::kAccess, std::max(now, access_time()));
    access_set_ = true;
  } else if (access_set_) {
    host_->cancel_timer(node_, MacTimer::kAccess);
    access_set_ = false;
  }
}

void Dcf::access(SimTime now) {
  while (attempts_ == 0 && !queue_.empty() &&
         now - queue_.front().queued_at > parameters_->queue_lifetime) {
    const Msdu expired = queue_.front();
    queue_.pop_front();
    host_->finished(node_, expired, SendOutcome::kLifetime, 0);
  }
  contending_ = false;
  immediate_ = false;
  if (queue_.empty()) {
    return;
  }
  const Msdu& msdu = queue_.front();
  if (attempts_++ == 0) {
    sequence_ = sequence_ == std::numeric_limits<std::uint32_t>::max() ? 1 : sequence_ + 1;
  }
  const bool group = msdu.destination == kGroup;
  const Mode& mode = group ? *parameters_->group_mode : *parameters_->data_mode;
  sending_ = Sending::kData;
  receiving_ = false;
  host_->transmit(
      node_,
      {.kind = MacFrame::Kind::kData,
       .sender = node_,
       .receiver = msdu.destination,
       .frame = msdu.frame,
       .sequence = sequence_,
       .duration = group ? Duration::zero()
                         : parameters_->sifs + airtime(*parameters_->ack_mode, kAckBytes)},
      mode, msdu.psdu_bytes);
}

void Dcf::respond(SimTime now) {
  response_due_ = false;
  if (sending_ != Sending::kNothing) {
    return;
  }
  if (!immediate_) {
    count_down(now);
  }
  sending_ = Sending::kAck;
  receiving_ = false;
  host_->transmit(node_, response_, *response_mode_, kAckBytes);
}

void Dcf::ack_missing(SimTime now) {
  awaiting_ack_ = false;
  host_->cancel_timer(node_, MacTimer::kAckTimeout);
  if (attempts_ >= parameters_->retry_limit) {
    complete(now, SendOutcome::kRetryLimit);
    return;
  }
  cw_ = std::min(2 * cw_ + 1, parameters_->cw_max);
  draw_backoff(now);
}

void Dcf::complete(SimTime now, SendOutcome outcome) {
  const Msdu done = queue_.front();
  const std::uint32_t attempts = attempts_;
  queue_.pop_front();
  attempts_ = 0;
  cw_ = parameters_->cw_min;
  if (outcome == SendOutcome::kAcknowledged) {
    awaiting_ack_ = false;
    host_->cancel_timer(node_, MacTimer::kAckTimeout);
  }
  draw_backoff(now);
  host_->finished(node_, done, outcome, attempts);
}

}  // namespace cuscus::netsim
