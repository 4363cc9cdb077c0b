#include "netsim/mac/dcf.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace cuscus::netsim {

Dcf::Dcf(std::uint32_t node, const MacParameters& parameters, MacHost& host, RateControl& rates,
         random::CounterStream backoffs)
    : node_{node},
      parameters_{&parameters},
      host_{&host},
      rates_{&rates},
      backoffs_{backoffs},
      mode_{parameters.data_mode},
      cw_{parameters.cw_min},
      // The medium was idle before the run began.
      idle_since_{SimTime{} - parameters.eifs},
      nav_until_{idle_since_},
      nav_without_rts_{idle_since_},
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
  if (contending_ && !busy_ && !sending_ && access_time() <= now) {
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
  if (std::exchange(eifs_due_, false)) {
    eifs_until_ = now + parameters_->eifs - parameters_->difs;
  }
  schedule_access(now);
}

void Dcf::reception_started(SimTime /*now*/) {
  receiving_ = true;
  host_->cancel_timer(node_, MacTimer::kNavReset);
}

void Dcf::reception_failed(SimTime now) {
  const bool was_receiving = std::exchange(receiving_, false);
  // EIFS begins when the medium is idle after the frame that failed (10.3.2.3.7).
  eifs_due_ = busy_;
  if (!busy_) {
    eifs_until_ = now + parameters_->eifs - parameters_->difs;
  }
  // A header that failed is no PHY-RXSTART: the answer may still come before the timeout.
  if (was_receiving && awaited_ && !sending_) {
    answer_missing(now);
  }
  schedule_access(now);
}

bool Dcf::received(SimTime now, const MacFrame& frame, const Mode& mode) {
  receiving_ = false;
  eifs_due_ = false;
  eifs_until_ = std::min(eifs_until_, now);
  const bool mine = frame.receiver == static_cast<std::int32_t>(node_);
  if (!mine) {
    set_nav(now, frame, mode);
  }
  if (awaited_ && !sending_) {
    if (!answers(frame)) {
      answer_missing(now);
    } else if (frame.kind == Kind::kAck) {
      report_attempt(now, true);
      complete(now, SendOutcome::kAcknowledged);
    } else {
      awaited_.reset();
      host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
      short_failures_ = 0;
      respond_after_sifs(now, {.kind = Kind::kData}, *mode_);
    }
  }
  bool deliver = frame.kind == Kind::kData && frame.receiver == kGroup;
  if (mine && frame.kind == Kind::kData) {
    respond_after_sifs(
        now,
        {.kind = Kind::kAck, .sender = node_, .receiver = static_cast<std::int32_t>(frame.sender)},
        parameters_->answer_to(mode));
    if (last_sequence_.size() <= frame.sender) {
      last_sequence_.resize(frame.sender + std::size_t{1}, 0);
    }
    deliver = last_sequence_[frame.sender] != frame.sequence;
    last_sequence_[frame.sender] = frame.sequence;
  }
  if (mine && frame.kind == Kind::kRts && nav_until_ <= now) {
    const Mode& answer = parameters_->answer_to(mode);
    respond_after_sifs(now,
                       {.kind = Kind::kCts,
                        .sender = node_,
                        .receiver = static_cast<std::int32_t>(frame.sender),
                        .duration = std::max(Duration::zero(), frame.duration - parameters_->sifs -
                                                                   airtime(answer, kCtsBytes))},
                       answer);
  }
  schedule_access(now);
  return deliver;
}

bool Dcf::answers(const MacFrame& frame) const {
  return frame.receiver == static_cast<std::int32_t>(node_) && frame.kind == awaited_;
}

void Dcf::set_nav(SimTime now, const MacFrame& frame, const Mode& mode) {
  const SimTime until = now + frame.duration;
  if (until <= nav_until_ || frame.duration <= Duration::zero()) {
    return;
  }
  if (frame.kind == Kind::kRts) {
    const Mode& answer = parameters_->answer_to(mode);
    nav_without_rts_ = nav_until_;
    host_->set_timer(node_, MacTimer::kNavReset,
                     now + 2 * parameters_->sifs + airtime(answer, kCtsBytes) +
                         answer.format->receive_start_delay + 2 * parameters_->slot);
  } else {
    host_->cancel_timer(node_, MacTimer::kNavReset);
  }
  nav_until_ = until;
}

void Dcf::respond_after_sifs(SimTime now, const MacFrame& response, const Mode& mode) {
  response_ = response;
  response_mode_ = &mode;
  response_due_ = true;
  host_->set_timer(node_, MacTimer::kResponse, now + parameters_->sifs);
}

void Dcf::transmission_ended(SimTime now) {
  const std::optional<Kind> sent = std::exchange(sending_, std::nullopt);
  idle_since_ = now;
  if (sent == Kind::kData && queue_.front().destination == kGroup) {
    complete(now, SendOutcome::kSent);
  } else if (sent == Kind::kData || sent == Kind::kRts) {
    const Mode& mode = sent == Kind::kRts ? *parameters_->rts_mode : *mode_;
    awaited_ = sent == Kind::kRts ? Kind::kCts : Kind::kAck;
    host_->set_timer(node_, MacTimer::kAnswerTimeout, now + parameters_->answer_timeout(mode));
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
    case MacTimer::kAnswerTimeout:
      if (awaited_ && !receiving_) {  // else the reception that is under way decides
        answer_missing(now);
        schedule_access(now);
      }
      break;
    case MacTimer::kNavReset:
      nav_until_ = std::min(nav_until_, std::max(nav_without_rts_, now));
      schedule_access(now);
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
  if (!contending_ || immediate_ || busy_ || sending_) {
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
  const bool possible =
      contending_ && !queue_.empty() && !busy_ && !awaited_ && !response_due_ && !sending_;
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
  if (msdu.destination == kGroup) {
    mode_ = parameters_->group_mode;
  } else if (msdu.destination == kNobody) {
    mode_ = parameters_->data_mode;
  } else {
    mode_ = &rates_->mode(now, static_cast<std::uint32_t>(msdu.destination), attempts_);
  }
  if (attempts_++ == 0) {
    sequence_ = sequence_ == std::numeric_limits<std::uint32_t>::max() ? 1 : sequence_ + 1;
  }
  if (msdu.destination == kGroup || msdu.psdu_bytes <= parameters_->rts_threshold_bytes) {
    send_data();
    return;
  }
  const MacParameters& p = *parameters_;
  const Mode& cts = p.answer_to(*p.rts_mode);
  sending_ = Kind::kRts;
  receiving_ = false;
  host_->transmit(
      node_,
      {.kind = Kind::kRts,
       .sender = node_,
       .receiver = msdu.destination,
       .frame = msdu.frame,
       .duration = 3 * p.sifs + airtime(cts, kCtsBytes) + airtime(*mode_, msdu.psdu_bytes) +
                   airtime(p.answer_to(*mode_), kAckBytes)},
      *p.rts_mode, kRtsBytes);
}

void Dcf::send_data() {
  const Msdu& msdu = queue_.front();
  const bool group = msdu.destination == kGroup;
  sending_ = Kind::kData;
  receiving_ = false;
  host_->transmit(
      node_,
      {.kind = Kind::kData,
       .sender = node_,
       .receiver = msdu.destination,
       .frame = msdu.frame,
       .sequence = sequence_,
       .duration = group ? Duration::zero()
                         : parameters_->sifs + airtime(parameters_->answer_to(*mode_), kAckBytes)},
      *mode_, msdu.psdu_bytes);
}

void Dcf::respond(SimTime now) {
  response_due_ = false;
  if (sending_) {
    return;
  }
  if (!immediate_) {
    count_down(now);
  }
  if (response_.kind == Kind::kData) {
    send_data();
    return;
  }
  sending_ = response_.kind;
  receiving_ = false;
  static_assert(kAckBytes == kCtsBytes);
  host_->transmit(node_, response_, *response_mode_, kAckBytes);
}

void Dcf::answer_missing(SimTime now) {
  const MacParameters& p = *parameters_;
  const bool after_rts = queue_.front().psdu_bytes > p.rts_threshold_bytes;
  const bool long_attempt = awaited_ == Kind::kAck && after_rts;
  if (awaited_ == Kind::kAck) {
    report_attempt(now, false);
  }
  awaited_.reset();
  host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
  ++(long_attempt ? long_failures_ : short_failures_);
  if (short_failures_ >= p.short_retry_limit || long_failures_ >= p.long_retry_limit) {
    complete(now, SendOutcome::kRetryLimit);
    return;
  }
  cw_ = std::min(2 * cw_ + 1, p.cw_max);
  draw_backoff(now);
}

void Dcf::report_attempt(SimTime now, bool acknowledged) {
  const std::int32_t destination = queue_.front().destination;
  if (destination >= 0) {
    rates_->report(now, static_cast<std::uint32_t>(destination), *mode_, acknowledged);
  }
}

void Dcf::complete(SimTime now, SendOutcome outcome) {
  const Msdu done = queue_.front();
  const std::uint32_t attempts = attempts_;
  queue_.pop_front();
  attempts_ = 0;
  short_failures_ = 0;
  long_failures_ = 0;
  cw_ = parameters_->cw_min;
  if (outcome == SendOutcome::kAcknowledged) {
    awaited_.reset();
    host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
  }
  draw_backoff(now);
  host_->finished(node_, done, outcome, attempts);
}

}  // namespace cuscus::netsim
