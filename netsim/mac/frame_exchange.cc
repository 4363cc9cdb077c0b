// The exchange of frames: Csma's other half.
#include <algorithm>
#include <limits>
#include <utility>

#include "netsim/mac/csma.h"

namespace cuscus::netsim {

void Csma::reception_started(SimTime /*now*/) {
  receiving_ = true;
  host_->cancel_timer(node_, MacTimer::kNavReset);
}

void Csma::reception_failed(SimTime now) {
  const bool was_receiving = std::exchange(receiving_, false);
  sense_.reception_failed(now);
  // A header that failed is no PHY-RXSTART: the answer may still come before the timeout.
  if (was_receiving && awaited_ && !sending_) {
    answer_missing(now);
  }
  schedule_access(now);
}

bool Csma::received(SimTime now, const MacFrame& frame, const Mode& mode) {
  receiving_ = false;
  sense_.reception_succeeded(now);
  const bool mine = frame.receiver == static_cast<std::int32_t>(node_);
  if (!mine) {
    set_nav(now, frame, mode);
  }
  if (awaited_ && !sending_) {
    answer_received(now, frame);
  }
  bool deliver = frame.kind == Kind::kData && frame.receiver == kGroup;
  if (mine && frame.kind == Kind::kData) {
    acknowledge(now, frame, mode);
    deliver = is_new(frame);
  }
  if (mine && frame.kind == Kind::kRts && !sense_.reserved(now)) {
    clear_to_send(now, frame, mode);
  }
  schedule_access(now);
  return deliver;
}

/// What comes while an answer is awaited is it, or takes its place.
void Csma::answer_received(SimTime now, const MacFrame& frame) {
  if (frame.receiver != static_cast<std::int32_t>(node_) || frame.kind != awaited_) {
    answer_missing(now);
    return;
  }
  Contender& contender = *current_;
  if (frame.kind == Kind::kAck) {
    report_attempt(now, contender, true);
    awaited_.reset();
    current_ = nullptr;
    host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
    complete(now, contender, SendOutcome::kAcknowledged);
  } else {
    awaited_.reset();
    host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
    contender.short_failures = 0;
    respond_after_sifs(now, {.kind = Kind::kData}, *mode_);
  }
}

void Csma::acknowledge(SimTime now, const MacFrame& data, const Mode& mode) {
  respond_after_sifs(
      now,
      {.kind = Kind::kAck, .sender = node_, .receiver = static_cast<std::int32_t>(data.sender)},
      parameters_->answer_to(mode));
}

void Csma::clear_to_send(SimTime now, const MacFrame& rts, const Mode& mode) {
  const Mode& answer = parameters_->answer_to(mode);
  respond_after_sifs(now,
                     {.kind = Kind::kCts,
                      .sender = node_,
                      .receiver = static_cast<std::int32_t>(rts.sender),
                      .duration = std::max(Duration::zero(), rts.duration - parameters_->sifs -
                                                                 airtime(answer, kCtsBytes))},
                     answer);
}

/// Whether it is no repetition of the frame that its sender sent before in that category.
bool Csma::is_new(const MacFrame& data) {
  const std::size_t place = data.sender * contenders_.size() + data.category;
  if (last_sequence_.size() <= place) {
    last_sequence_.resize((data.sender + std::size_t{1}) * contenders_.size(), 0);
  }
  return std::exchange(last_sequence_[place], data.sequence) != data.sequence;
}

void Csma::set_nav(SimTime now, const MacFrame& frame, const Mode& mode) {
  const bool rts = frame.kind == Kind::kRts;
  if (!sense_.reserve(now, frame.duration, rts)) {
    return;
  }
  if (rts) {
    const Mode& answer = parameters_->answer_to(mode);
    host_->set_timer(node_, MacTimer::kNavReset,
                     now + 2 * parameters_->sifs + airtime(answer, kCtsBytes) +
                         answer.format->receive_start_delay + 2 * parameters_->slot);
  } else {
    host_->cancel_timer(node_, MacTimer::kNavReset);
  }
}

void Csma::respond_after_sifs(SimTime now, const MacFrame& response, const Mode& mode) {
  response_ = response;
  response_mode_ = &mode;
  response_due_ = true;
  host_->set_timer(node_, MacTimer::kResponse, now + parameters_->sifs);
}

void Csma::transmission_ended(SimTime now) {
  const std::optional<Kind> sent = std::exchange(sending_, std::nullopt);
  sense_.transmission_ended(now);
  if (sent == Kind::kData && current_->queue.front().destination == kGroup) {
    complete(now, *std::exchange(current_, nullptr), SendOutcome::kSent);
  } else if (sent == Kind::kData || sent == Kind::kRts) {
    const Mode& mode = sent == Kind::kRts ? *parameters_->rts_mode : *mode_;
    awaited_ = sent == Kind::kRts ? Kind::kCts : Kind::kAck;
    host_->set_timer(node_, MacTimer::kAnswerTimeout, now + parameters_->answer_timeout(mode));
  }
  schedule_access(now);
}

void Csma::timer(SimTime now, MacTimer timer) {
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
      sense_.take_back(now);
      schedule_access(now);
      break;
  }
}

void Csma::begin_exchange(SimTime now, Contender& contender) {
  current_ = &contender;
  const Msdu& msdu = contender.queue.front();
  if (msdu.destination == kGroup) {
    mode_ = parameters_->group_mode;
  } else if (msdu.destination == kNobody) {
    mode_ = parameters_->data_mode;
  } else {
    mode_ = &rates_->mode(now, static_cast<std::uint32_t>(msdu.destination), contender.attempts);
  }
  if (contender.attempts++ == 0) {
    std::uint32_t& sequence = contender.sequence;
    sequence = sequence == std::numeric_limits<std::uint32_t>::max() ? 1 : sequence + 1;
  }
  if (msdu.destination == kGroup || msdu.psdu_bytes <= parameters_->rts_threshold_bytes) {
    send_data();
  } else {
    send_rts();
  }
}

void Csma::send_rts() {
  const Msdu& msdu = current_->queue.front();
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

void Csma::send_data() {
  const Msdu& msdu = current_->queue.front();
  const bool group = msdu.destination == kGroup;
  sending_ = Kind::kData;
  receiving_ = false;
  host_->transmit(
      node_,
      {.kind = Kind::kData,
       .sender = node_,
       .receiver = msdu.destination,
       .frame = msdu.frame,
       .sequence = current_->sequence,
       .category = category_of_[msdu.priority],
       .duration = group ? Duration::zero()
                         : parameters_->sifs + airtime(parameters_->answer_to(*mode_), kAckBytes)},
      *mode_, msdu.psdu_bytes);
}

void Csma::respond(SimTime now) {
  response_due_ = false;
  if (sending_) {
    return;
  }
  count_down(now);
  if (response_.kind == Kind::kData) {
    send_data();
    return;
  }
  sending_ = response_.kind;
  receiving_ = false;
  static_assert(kAckBytes == kCtsBytes);
  host_->transmit(node_, response_, *response_mode_, kAckBytes);
}

void Csma::answer_missing(SimTime now) {
  Contender& contender = *std::exchange(current_, nullptr);
  const bool after_rts = contender.queue.front().psdu_bytes > parameters_->rts_threshold_bytes;
  const bool long_attempt = awaited_ == Kind::kAck && after_rts;
  if (awaited_ == Kind::kAck) {
    report_attempt(now, contender, false);
  }
  awaited_.reset();
  host_->cancel_timer(node_, MacTimer::kAnswerTimeout);
  ++(long_attempt ? contender.long_failures : contender.short_failures);
  for (Contender& other : contenders_) {
    other.backoff.hold(now);
  }
  back_off_after_failure(now, contender);
}

void Csma::report_attempt(SimTime now, const Contender& contender, bool acknowledged) {
  const std::int32_t destination = contender.queue.front().destination;
  if (destination >= 0) {
    rates_->report(now, static_cast<std::uint32_t>(destination), *mode_, acknowledged);
  }
}

}  // namespace cuscus::netsim
