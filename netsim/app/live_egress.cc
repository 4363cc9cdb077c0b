// How frames leave: what the air delivers goes into the receivers' interfaces.
#include <algorithm>

#include "netsim/app/live_air.h"

namespace cuscus::netsim {
namespace {

/// A copy that is later than this is not written: it would only make the others later still. Such a
/// run is INVALID in any case (docs/fidelity.md).
constexpr std::int64_t kLatestRelease_ns = 1'000'000'000;
/// From here on a release counts as late: 0.52 ms, as in the verdict.
constexpr std::int64_t kLateRelease_ns = std::int64_t{1} << 19U;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

}  // namespace

void LiveAir::delivered(const Delivery& delivery) {
  const auto number = static_cast<std::uint32_t>(delivery.id);
  LiveFrame& frame = frames_[number];
  if (radio_memory_) {
    radio_memory_->publish_link(delivery.receiver, delivery.sender,
                                {.received_dbm = static_cast<float>(delivery.received_power.value),
                                 .rate_kbps = delivery.rate_kbps,
                                 .sim_time_ms = static_cast<std::uint32_t>(
                                     to_ns(delivery.time) / kNanosecondsPerMillisecond)});
    link_counts_->delivered(delivery);
  }
  if (frame.payload == LiveFrame::Payload::kLost) {
    lose_copy({.frame = number, .receiver = delivery.receiver, .due = delivery.time},
              logs::Cause::kNeverCame);
    return;
  }
  ++frame.copies;
  copies_.add({.frame = number, .receiver = delivery.receiver, .due = delivery.time});
}

void LiveAir::finished(const FrameReport& report) {
  const auto number = static_cast<std::uint32_t>(report.id);
  LiveFrame& frame = frames_[number];
  --ports_[frame.node].outstanding;
  if (link_counts_) {
    link_counts_->finished(report);
  }
  if (receptions_) {
    receptions_->finished(report);
  }
  if (log_) {
    log_->add({.sent_ns = frame.sent_ns,
               .node = frame.node,
               .destination = report.destination,
               .frame_bytes = frame.frame_bytes,
               .attempts = report.attempts,
               .outcome = report.outcome,
               .deliveries = report.deliveries,
               .first_delivery_ns = report.deliveries > 0 ? to_ns(report.first_delivery) : 0,
               .priority = report.priority});
  }
  frame.air_done = true;
  frames_.drop_if_over(number);
}

/// A frame that was received does not get into the receiver's interface.
void LiveAir::lose_copy(const DueCopy& copy, logs::Cause cause) {
  const std::uint32_t sender = frames_[copy.frame].node;
  ++ports_[copy.receiver].lost_interface;
  if (link_counts_) {
    link_counts_->lost_at_interface(sender, copy.receiver);
  }
  if (receptions_) {
    receptions_->copy_lost(frames_.id_of(copy.frame), sender, copy.receiver, copy.due, cause);
  }
}

void LiveAir::write_one_copy() {
  const DueCopy copy = copies_.take_first();
  const bool too_late = now_ns() - to_ns(copy.due) > kLatestRelease_ns;
  LiveFrame& frame = frames_[copy.frame];
  if (frame.payload == LiveFrame::Payload::kAwaited && !too_late) {
    read_tap(frame.node);
  }
  LiveFrame& again = frames_[copy.frame];  // reading may have added frames
  if (again.payload == LiveFrame::Payload::kAwaited && !too_late) {
    again.late.push_back(copy);
    // Looked for at once and often to begin with; one that the kernel lost, ever more seldom.
    service_ns_ = kService_ns;
    service_at_ = now_ns() + service_ns_;
    return;
  }
  Port& port = ports_[copy.receiver];
  if (again.payload == LiveFrame::Payload::kLost) {
    lose_copy(copy, logs::Cause::kNeverCame);
  } else if (port.tap.fd() < 0) {
    lose_copy(copy, logs::Cause::kLinkDown);
  } else {
    if (!canary_.has(copy.receiver)) {
      note_lateness(port, now_ns() - to_ns(copy.due));
    }
    if (too_late) {
      lose_copy(copy, logs::Cause::kLate);
    } else if (!port.tap.write(again.bytes)) {
      lose_copy(copy, logs::Cause::kLinkDown);
    }
  }
  --again.copies;
  frames_.drop_if_over(copy.frame);
}

void LiveAir::note_lateness(Port& port, std::int64_t lateness_ns) {
  release_lateness_.add(lateness_ns);
  ++port.releases;
  port.late_releases += lateness_ns >= kLateRelease_ns ? 1U : 0U;
  port.release_lateness_max_ns = std::max(port.release_lateness_max_ns, lateness_ns);
}

}  // namespace cuscus::netsim
