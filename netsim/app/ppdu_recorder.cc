#include "netsim/app/ppdu_recorder.h"

#include <utility>

namespace cuscus::netsim {
namespace {

/// A fifth of a second, for which a lost payload is waited for, of 300 000 receptions per second.
constexpr std::size_t kMostWaiting = std::size_t{1} << 16U;

std::uint32_t frame_of(const PpduRecord& record) {
  return static_cast<std::uint32_t>(record.ppdu.offer_id);
}

}  // namespace

void PpduRecorder::transmitted(const Ppdu& ppdu) {
  record({.node = ppdu.frame.sender, .own = true, .ppdu = ppdu});
}

void PpduRecorder::received(const Ppdu& ppdu, const Reception& reception) {
  record({.node = reception.receiver, .ppdu = ppdu, .reception = reception});
}

void PpduRecorder::record(const PpduRecord& record) {
  if (!captures_->wants(record)) {
    return;
  }
  const bool payload = needs_payload(record.ppdu);
  if (waiting_.empty() &&
      (!payload || (*frames_)[frame_of(record)].payload == LiveFrame::Payload::kHere)) {
    give(record);
    return;
  }
  if (waiting_.size() >= kMostWaiting) {
    leave_out(record);
    return;
  }
  waiting_.push_back(record);
  if (payload) {
    ++(*frames_)[frame_of(record)].records;
  }
}

/// False when it has to wait on.
bool PpduRecorder::hand_over_first() {
  const PpduRecord& first = waiting_.front();
  if (needs_payload(first.ppdu)) {
    LiveFrame& frame = (*frames_)[frame_of(first)];
    if (frame.payload == LiveFrame::Payload::kAwaited) {
      return false;
    }
    if (frame.payload == LiveFrame::Payload::kHere) {
      give(first);
    } else {
      leave_out(first);
    }
    --frame.records;
    frames_->drop_if_over(frame_of(first));
  } else {
    give(first);
  }
  waiting_.pop_front();
  return true;
}

void PpduRecorder::give(const PpduRecord& record) {
  captures_->add(record, needs_payload(record.ppdu)
                             ? std::span<const std::uint8_t>{(*frames_)[frame_of(record)].bytes}
                             : std::span<const std::uint8_t>{});
}

void PpduRecorder::leave_out(const PpduRecord& record) { captures_->leave_out(record.node); }

void PpduRecorder::finish() {
  hand_over();
  for (const PpduRecord& record : std::exchange(waiting_, {})) {
    leave_out(record);
  }
  captures_->finish();
}

}  // namespace cuscus::netsim
