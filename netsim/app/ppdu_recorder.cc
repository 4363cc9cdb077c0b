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

// Most PPDUs are wanted by nobody: to find that out must cost next to nothing.
void PpduRecorder::transmitted(const Ppdu& ppdu) {
  const Takers takers = takers_of(ppdu.frame.sender, LossCause::kNone);
  if (takers.captures || takers.monitor) {
    record({.ppdu = {.node = ppdu.frame.sender, .own = true, .ppdu = ppdu}, .takers = takers});
  }
}

void PpduRecorder::received(const Ppdu& ppdu, const Reception& reception) {
  const Takers takers = takers_of(reception.receiver, reception.cause);
  if (takers.captures || takers.monitor) {
    record({.ppdu = {.node = reception.receiver, .ppdu = ppdu, .reception = reception},
            .takers = takers});
  }
}

PpduRecorder::Takers PpduRecorder::takers_of(std::uint32_t node, LossCause cause) const {
  return {.captures = captures_ && captures_->wants(node, cause),
          .monitor = monitors_ && cause == LossCause::kNone && monitors_->wants(node)};
}

void PpduRecorder::record(const Record& record) {
  const PpduRecord& ppdu = record.ppdu;
  const bool payload = needs_payload(ppdu.ppdu);
  if (waiting_.empty() &&
      (!payload || (*frames_)[frame_of(ppdu)].payload == LiveFrame::Payload::kHere)) {
    give(record);
    return;
  }
  if (waiting_.size() >= kMostWaiting) {
    leave_out(record);
    return;
  }
  waiting_.push_back(record);
  if (payload) {
    ++(*frames_)[frame_of(ppdu)].records;
  }
}

/// False when it has to wait on.
bool PpduRecorder::hand_over_first() {
  const Record& first = waiting_.front();
  if (needs_payload(first.ppdu.ppdu)) {
    LiveFrame& frame = (*frames_)[frame_of(first.ppdu)];
    if (frame.payload == LiveFrame::Payload::kAwaited) {
      return false;
    }
    if (frame.payload == LiveFrame::Payload::kHere) {
      give(first);
    } else {
      leave_out(first);
    }
    --frame.records;
    frames_->drop_if_over(frame_of(first.ppdu));
  } else {
    give(first);
  }
  waiting_.pop_front();
  return true;
}

void PpduRecorder::give(const Record& record) {
  std::span<const std::uint8_t> ethernet;
  if (needs_payload(record.ppdu.ppdu)) {
    ethernet = (*frames_)[frame_of(record.ppdu)].bytes;
  }
  if (record.takers.captures) {
    captures_->add(record.ppdu, ethernet);
  }
  if (record.takers.monitor) {
    monitors_->add(record.ppdu, ethernet);
  }
}

void PpduRecorder::leave_out(const Record& record) {
  if (record.takers.captures) {
    captures_->leave_out(record.ppdu.node);
  }
  if (record.takers.monitor) {
    monitors_->leave_out(record.ppdu.node);
  }
}

void PpduRecorder::finish() {
  hand_over();
  for (const Record& record : std::exchange(waiting_, {})) {
    leave_out(record);
  }
  if (captures_) {
    captures_->finish();
  }
  if (monitors_) {
    monitors_->finish();
  }
}

}  // namespace cuscus::netsim
