// How frames enter: LiveAir's other half.
#include <spdlog/spdlog.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "netsim/app/live_air.h"

namespace cuscus::netsim {
namespace {

/// Frames read from one TAP in a row: a node that floods must not keep the others waiting.
constexpr int kReadBudget = 32;
/// Frames of a node that the air takes beyond what its MAC queue holds, since event time trails the
/// clock: as many as a TAP holds. In 50 ms, the latest that a release of a VALID run may be, the
/// air cannot send more.
constexpr std::uint64_t kBeyondQueue = 1'000;
/// A frame that has not come out of its TAP after this long never will.
constexpr std::int64_t kPayloadTimeout_ns = 200'000'000;

}  // namespace

/// Takes what is in the ring by now: a node that floods must not keep us here.
void LiveAir::drain_stamps() {
  if (!stamps_) {
    return;
  }
  RingReader& ring = stamps_->reader();
  const std::uint64_t end = ring.end();
  while (const auto stamp = ring.next(end)) {
    take(*stamp);
  }
}

void LiveAir::take(const shm::SendStamp& stamp) {
  if (stamp.node >= ports_.size()) {
    return;
  }
  // The little that was sent just before the run counts as sent when it began.
  const std::int64_t sent_ns =
      std::max<std::int64_t>(0, static_cast<std::int64_t>(stamp.monotonic_ns) - start_ns_);
  const std::uint32_t frame = frames_.add(stamp.node, stamp.frame_bytes, sent_ns);
  ports_[stamp.node].matcher.expect(frame, stamp);
  ++awaited_;
  const std::size_t head = std::min(stamp.frame_bytes, shm::SendStamp::kHeadBytes);
  offer(frame, std::span{stamp.head}.first(head), now_ns());
}

/// Hands a frame to the MAC at the time at which it was sent.
void LiveAir::offer(std::uint32_t frame, std::span<const std::uint8_t> head,
                    std::int64_t entered_ns) {
  LiveFrame& live = frames_[frame];
  if (canary_.has(live.node)) {
    live.air_done = true;
    ++live.copies;
    canary_.sent(frame, live.node, live.sent_ns);
    return;
  }
  const auto parsed = parse_ethernet(head, live.frame_bytes);
  if (!parsed) {
    ++ports_[live.node].malformed;
    live.air_done = true;
    frames_.drop_if_over(frame);
    return;
  }
  const OfferedFrame offered{.id = frames_.id_of(frame),
                             .destination = addresses_.destination(*parsed),
                             .psdu_bytes = psdu_bytes_of_ethernet(live.frame_bytes),
                             .priority = parsed->priority};
  ingress_delay_.add(entered_ns - live.sent_ns);
  Port& port = ports_[live.node];
  if (++port.outstanding > air_->queue_places() + kBeyondQueue) {
    ++port.refused;
    FrameReport refused = FrameReport::of(live.node, sim_time(live.sent_ns), offered);
    refused.outcome = SendOutcome::kQueueFull;
    finished(refused);
    return;
  }
  port.most_outstanding = std::max(port.most_outstanding, port.outstanding);
  if (live.sent_ns < to_ns(air_->now())) {
    clamp_.add(to_ns(air_->now()) - live.sent_ns);
    ++port.clamps;
  }
  air_->offer(live.node, sim_time(live.sent_ns), offered);
}

/// Reads every TAP that has something, a bounded number of frames each; false when none had.
bool LiveAir::service_taps() {
  constexpr int kPorts = 64;
  bool any = false;
  if (held_ > 0) {
    for (std::uint32_t node = 0; node < ports_.size(); ++node) {
      if (!ports_[node].held.empty()) {
        any = read_tap(node) || any;
      }
    }
  }
  std::array<::epoll_event, kPorts> events{};
  const int count = ::epoll_wait(taps_.get(), events.data(), kPorts, 0);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t node = events.at(static_cast<std::size_t>(i)).data.u32;
    any = read_tap(node) || any;
    Port& port = ports_[node];
    const bool hung_up =
        (events.at(static_cast<std::size_t>(i)).events & (EPOLLERR | EPOLLHUP)) != 0;
    if ((port.tap.failed() != 0 || hung_up) && !port.failure_logged) {
      port.failure_logged = true;
      // Left in the set it would wake us for ever.
      static_cast<void>(::epoll_ctl(taps_.get(), EPOLL_CTL_DEL, port.tap.fd(), nullptr));
      spdlog::warn("node {}: its TAP failed (errno {}); the node is silent from now on", node,
                   port.tap.failed());
    }
  }
  return any;
}

/// False when there was nothing to read.
bool LiveAir::read_tap(std::uint32_t node) {
  if (ports_[node].tap.fd() < 0) {
    return false;
  }
  ports_[node].emptied = false;
  if (!ports_[node].held.empty()) {
    std::vector<std::uint8_t> held;
    held.swap(ports_[node].held);
    --held_;
    if (!take(node, held)) {
      return true;
    }
  }
  for (int budget = kReadBudget; budget > 0; --budget) {
    const auto bytes = ports_[node].tap.read(buffer_);
    if (!bytes) {
      ports_[node].emptied = true;
      return budget < kReadBudget;
    }
    if (!take(node, *bytes)) {
      return true;
    }
  }
  return true;
}

/// A frame came out of a TAP. False when it has to wait for its stamp.
bool LiveAir::take(std::uint32_t node, std::span<const std::uint8_t> bytes) {
  Port& port = ports_[node];
  if (stamps_) {
    auto match = port.matcher.match(bytes);
    if (!match.token) {
      drain_stamps();  // the stamp was written before the frame: it may have come meanwhile
      match = port.matcher.match(bytes);
    }
    lost(match.lost);
    if (match.token) {
      arrived(*match.token, bytes);
      return true;
    }
    if (stamps_->reader().blocked()) {
      port.held.assign(bytes.begin(), bytes.end());
      ++held_;
      return false;
    }
    ++unstamped_;
  }
  const std::int64_t now = now_ns();
  const std::uint32_t frame = frames_.add(node, static_cast<std::uint32_t>(bytes.size()), now);
  frames_[frame].bytes.assign(bytes.begin(), bytes.end());
  frames_[frame].payload = LiveFrame::Payload::kHere;
  offer(frame, bytes, now);
  return true;
}

/// The bytes of a frame that is known already.
void LiveAir::arrived(std::uint32_t frame, std::span<const std::uint8_t> bytes) {
  LiveFrame& live = frames_[frame];
  live.payload = LiveFrame::Payload::kHere;
  --awaited_;
  if (live.over()) {
    frames_.drop_if_over(frame);
    return;
  }
  live.bytes.assign(bytes.begin(), bytes.end());
  for (const DueCopy& copy : live.late) {
    copies_.add(copy);
  }
  live.late.clear();
}

/// Gives up on frames that were stamped long ago and are in no TAP. After a stall of our own there
/// may be many to read first.
void LiveAir::give_up_lost_frames(std::int64_t now) {
  const auto deadline =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, start_ns_ + now - kPayloadTimeout_ns));
  for (std::uint32_t node = 0; node < ports_.size(); ++node) {
    StampMatcher& matcher = ports_[node].matcher;
    if (!matcher.overdue(deadline)) {
      continue;
    }
    read_tap(node);
    if (ports_[node].emptied) {
      lost(matcher.expire(deadline));
    }
  }
}

/// Frames that were stamped and will never come.
void LiveAir::lost(std::span<const std::uint32_t> frames) {
  for (const std::uint32_t frame : frames) {
    LiveFrame& live = frames_[frame];
    live.payload = LiveFrame::Payload::kLost;
    --awaited_;
    ++ports_[live.node].before_air;
    for (const DueCopy& copy : live.late) {
      lose_copy(copy, logs::Cause::kNeverCame);
      --live.copies;
    }
    live.late.clear();
    frames_.drop_if_over(frame);
  }
}

}  // namespace cuscus::netsim
