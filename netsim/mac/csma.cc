#include "netsim/mac/csma.h"

#include <algorithm>
#include <cassert>

namespace cuscus::netsim {

AccessProfile dcf_access(const MacParameters& parameters) {
  return {.categories = {
              {.aifs = parameters.difs, .cw_min = parameters.cw_min, .cw_max = parameters.cw_max}}};
}

Csma::Csma(std::uint32_t node, const MacParameters& parameters, MacHost& host, RateControl& rates,
           random::CounterStream backoffs, const AccessProfile& profile)
    : node_{node},
      parameters_{&parameters},
      host_{&host},
      rates_{&rates},
      backoffs_{backoffs},
      category_of_{profile.category_of},
      more_header_bytes_{profile.more_header_bytes},
      sense_{parameters},
      mode_{parameters.data_mode} {
  contenders_.reserve(profile.categories.size());
  for (const AccessParameters& access : profile.categories) {
    contenders_.emplace_back(access, parameters.slot);
  }
}

void Csma::enqueue(SimTime now, const Msdu& msdu) {
  assert(msdu.priority < kPriorities);
  Contender& contender = contenders_[category_of_[msdu.priority]];
  if (contender.queue.size() >= parameters_->queue_frames) {
    host_->finished(node_, msdu, SendOutcome::kQueueFull, 0);
    return;
  }
  contender.queue.push_back(msdu);
  contender.queue.back().psdu_bytes += more_header_bytes_;
  if (contender.queue.size() > 1) {
    return;
  }
  Backoff& backoff = contender.backoff;
  const bool exchanging = current_ != nullptr;
  if (backoff.contending() && !sense_.busy() && !sending_ && !exchanging &&
      backoff.access_time(sense_.idle_since()) <= now) {
    backoff.end();  // a post-backoff that ran out unobserved
  }
  if (!backoff.contending()) {
    if (sense_.busy() || sense_.reserved(now) || exchanging) {
      draw_backoff(now, contender);
    } else {
      backoff.begin_at_once(now);
    }
  }
  schedule_access(now);
}

void Csma::medium_busy(SimTime now) {
  count_down(now);
  sense_.medium_busy();
  for (Contender& contender : contenders_) {
    if (contender.backoff.at_once()) {
      draw_backoff(now, contender);
    }
  }
  schedule_access(now);
}

void Csma::medium_idle(SimTime now) {
  sense_.medium_idle(now);
  schedule_access(now);
}

/// Charges the idle time up to `now` against the backoffs, before the medium becomes busy.
void Csma::count_down(SimTime now) {
  if (sense_.busy() || sending_ || current_ != nullptr) {
    return;
  }
  for (Contender& contender : contenders_) {
    contender.backoff.count_down(now, sense_.idle_since(), !contender.queue.empty());
  }
}

void Csma::draw_backoff(SimTime now, Contender& contender) {
  contender.backoff.begin(now, backoffs_.below(draw_++, contender.backoff.window() + 1));
}

void Csma::schedule_access(SimTime now) {
  std::optional<SimTime> first;
  if (!sense_.busy() && !awaited_ && !response_due_ && !sending_) {
    for (const Contender& contender : contenders_) {
      if (contender.backoff.contending() && !contender.queue.empty()) {
        const SimTime time = contender.backoff.access_time(sense_.idle_since());
        first = std::min(first.value_or(time), time);
      }
    }
  }
  if (first) {
    host_->set_timer(node_, MacTimer::kAccess, std::max(now, *first));
    access_set_ = true;
  } else if (access_set_) {
    host_->cancel_timer(node_, MacTimer::kAccess);
    access_set_ = false;
  }
}

void Csma::access(SimTime now) {
  Contender* winner = nullptr;
  for (std::size_t category = contenders_.size(); category-- > 0;) {
    Contender& contender = contenders_[category];
    if (!contender.backoff.contending() || contender.queue.empty() ||
        contender.backoff.access_time(sense_.idle_since()) > now) {
      continue;
    }
    drop_expired(now, contender);
    if (winner != nullptr && !contender.queue.empty()) {
      collide_internally(now, contender);
      continue;
    }
    contender.backoff.end();
    if (!contender.queue.empty()) {
      winner = &contender;
    }
  }
  if (winner == nullptr) {
    schedule_access(now);
    return;
  }
  interrupt_all_but(now, *winner);
  begin_exchange(now, *winner);
}

void Csma::drop_expired(SimTime now, Contender& contender) {
  while (contender.attempts == 0 && !contender.queue.empty() &&
         now - contender.queue.front().queued_at > parameters_->queue_lifetime) {
    const Msdu expired = contender.queue.front();
    contender.queue.pop_front();
    host_->finished(node_, expired, SendOutcome::kLifetime, 0);
  }
}

/// A higher category of the station sends at the very time (10.22.2.2).
void Csma::collide_internally(SimTime now, Contender& contender) {
  if (contender.queue.front().destination != kGroup) {
    ++contender.short_failures;
  }
  back_off_after_failure(now, contender);
}

/// The station's own transmission is a busy medium for its other categories.
void Csma::interrupt_all_but(SimTime now, const Contender& winner) {
  count_down(now);
  for (Contender& contender : contenders_) {
    if (&contender != &winner && contender.backoff.at_once()) {
      draw_backoff(now, contender);
    }
  }
}

void Csma::back_off_after_failure(SimTime now, Contender& contender) {
  if (contender.short_failures >= parameters_->short_retry_limit ||
      contender.long_failures >= parameters_->long_retry_limit) {
    complete(now, contender, SendOutcome::kRetryLimit);
    return;
  }
  contender.backoff.widen();
  draw_backoff(now, contender);
}

void Csma::complete(SimTime now, Contender& contender, SendOutcome outcome) {
  const Msdu done = contender.queue.front();
  const std::uint32_t attempts = contender.attempts;
  contender.queue.pop_front();
  contender.attempts = 0;
  contender.short_failures = 0;
  contender.long_failures = 0;
  contender.backoff.reset_window();
  draw_backoff(now, contender);
  host_->finished(node_, done, outcome, attempts);
}

}  // namespace cuscus::netsim
