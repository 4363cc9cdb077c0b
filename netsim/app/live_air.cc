#include "netsim/app/live_air.h"

#include <spdlog/spdlog.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>

#include "common/ipc/duration_summary.h"
#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/resource_usage.h"
#include "common/posix/scheduling.h"
#include "netsim/air/ideal_air.h"

namespace cuscus::netsim {
namespace {

constexpr std::int64_t kMicrosecond = 1'000;
constexpr std::int64_t kMillisecond = 1'000'000;

/// What was sent until this long before the start is thrown away.
constexpr std::int64_t kFlush_ns = 2 * kMillisecond;

/// A sleep ends this late at worst on a good day, so from here to the next release we spin.
constexpr std::int64_t kSpin_ns = 150 * kMicrosecond;
/// After this long without any sleep we spin less, to stay clear of the kernel's limit on real-time
/// threads (sched_rt_runtime_us).
constexpr std::int64_t kLongSpin_ns = 20 * kMillisecond;
constexpr std::int64_t kShortSpin_ns = 40 * kMicrosecond;
constexpr std::int64_t kNotWorthSleeping_ns = 10 * kMicrosecond;

constexpr std::int64_t kHousekeeping_ns = 10 * kMillisecond;
constexpr std::int64_t kBeat_ns = 500 * kMillisecond;
constexpr std::uint32_t kTicksPerPublication = 10;

/// Between looks at the TAPs while stamps announce frames.
constexpr std::int64_t kService_ns = 20 * kMicrosecond;
constexpr std::int64_t kSlowestService_ns = kMillisecond;
/// Events run in a row while a copy waits to be written.
constexpr int kEventBudget = 64;
/// A copy that is later than this is not written: it would only make the others later still. Such a
/// run is INVALID in any case (docs/fidelity.md).
constexpr std::int64_t kLatestRelease_ns = 1'000 * kMillisecond;
/// Patience with a stamp that is being written: longer, and its writer has lost its core.
constexpr std::int64_t kStampWrite_ns = 50 * kMicrosecond;

enum class Wake : std::uint32_t { kOwner = 0, kStamps = 1, kTaps = 2 };

posix::UniqueFd make_epoll() {
  return posix::UniqueFd{posix::check("epoll_create1", ::epoll_create1(EPOLL_CLOEXEC))};
}

void watch(const posix::UniqueFd& epoll, int fd, std::uint32_t label) {
  ::epoll_event event{};
  event.events = EPOLLIN;
  event.data.u32 = label;
  posix::check("epoll_ctl", ::epoll_ctl(epoll.get(), EPOLL_CTL_ADD, fd, &event));
}

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

LiveAir::LiveAir(LiveSetup setup, PositionSource& positions)
    : stamps_{std::move(setup.stamps)},
      log_{std::move(setup.log)},
      air_{make_air(setup.air, positions, *this, &monitors_)},
      wake_{make_epoll()},
      taps_{make_epoll()},
      canary_{air_->node_count(), setup.canary_delay},
      buffer_(TapPort::kBufferBytes) {
  if (setup.addresses.size() != air_->node_count() ||
      setup.taps.size() != air_->node_count() + canary_.port_count()) {
    throw std::invalid_argument{"radio: every node needs an address and a TAP"};
  }
  for (std::uint32_t node = 0; node < air_->node_count(); ++node) {
    if (!addresses_.add(setup.addresses[node], node)) {
      throw std::invalid_argument{"radio: node " + std::to_string(node) +
                                  " has the address of another"};
    }
  }
  for (posix::UniqueFd& tap : setup.taps) {
    ports_.emplace_back(std::move(tap));
    if (ports_.back().tap.fd() >= 0) {
      watch(taps_, ports_.back().tap.fd(), static_cast<std::uint32_t>(ports_.size() - 1));
    }
  }
  if (!setup.radio_memory.empty()) {
    radio_memory_.emplace(setup.radio_memory, air_->node_count());
    link_counts_.emplace(*radio_memory_);
    monitors_.add(*link_counts_);
  }
  if (setup.captures || setup.monitors) {
    recorder_.emplace(frames_, std::move(setup.captures), std::move(setup.monitors));
    monitors_.add(*recorder_);
  }
  tell_programs(setup);
  if (setup.reception_log) {
    receptions_.emplace(std::move(setup.reception_log), setup.air, setup.names, positions);
    monitors_.add(*receptions_);
  }
  if (stamps_) {
    watch(wake_, stamps_->fd(), static_cast<std::uint32_t>(Wake::kStamps));
  } else {
    watch(wake_, taps_.get(), static_cast<std::uint32_t>(Wake::kTaps));
  }
}

void LiveAir::tell_programs(const LiveSetup& setup) {
  const DecibelMilliwatt noise = receiver_noise(setup.air);
  const auto threshold_dbm = static_cast<float>(reception_threshold(setup.air, noise).value);
  std::vector<std::optional<shm::RadioReadingsWriter>> readings(air_->node_count());
  bool any = false;
  for (std::size_t node = 0; node < setup.radio_readings.size(); ++node) {
    if (!setup.radio_readings[node].empty()) {
      readings.at(node).emplace(setup.radio_readings[node], air_->node_count(), threshold_dbm);
      any = true;
    }
  }
  if (any) {
    neighbours_.emplace(std::move(readings), noise);
    monitors_.add(*neighbours_);
  }
}

std::int64_t LiveAir::now_ns() const { return posix::monotonic_now_ns() - start_ns_; }

void LiveAir::run(std::int64_t start_monotonic_ns, LiveOwner& owner) {
  start_ns_ = start_monotonic_ns;
  if (recorder_ && recorder_->captures() != nullptr) {
    recorder_->captures()->start(posix::realtime_now_ns() - now_ns());
  }
  watch(wake_, owner.fd(), static_cast<std::uint32_t>(Wake::kOwner));
  posix::sleep_until_monotonic(start_ns_ - kFlush_ns);
  forget_the_past();
  posix::sleep_until_monotonic(start_ns_);
  scheduler_ = posix::scheduling_class();
  slept_at_ = now_ns();
  while (!stop_) {
    step(owner);
  }
  posix::check("epoll_ctl", ::epoll_ctl(wake_.get(), EPOLL_CTL_DEL, owner.fd(), nullptr));
  publish(0, air_->node_count());
  publish_timing();
  cpu_s_ = posix::process_cpu_s();
  close_logs();
}

void LiveAir::close_logs() {
  not_logged_ = log_ ? log_->finish() : 0;
  receptions_not_logged_ = receptions_ ? receptions_->finish() : 0;
  const auto warn = [](const char* log, std::uint64_t missing) {
    if (missing > 0) {
      spdlog::warn("{}: {} records are missing: written not fast enough, or no more", log, missing);
    }
  };
  warn("frame log", not_logged_);
  warn("reception log", receptions_not_logged_);
  if (recorder_) {
    recorder_->finish();
    if (recorder_->captures() != nullptr) {
      warn("captures", recorder_->captures()->packets_left_out());
    }
  }
}

/// What the kernel sent before the run belongs to nobody. TAPs first: of a frame that is sent
/// meanwhile both stamp and bytes may survive, or the bytes alone, never the stamp alone.
void LiveAir::forget_the_past() {
  for (Port& port : ports_) {
    while (port.tap.fd() >= 0 && port.tap.read(buffer_)) {
    }
  }
  if (stamps_) {
    const std::uint64_t end = stamps_->reader().end();
    while (stamps_->reader().next(end)) {
    }
  }
}

void LiveAir::step(LiveOwner& owner) {
  run_due_events();
  if (recorder_) {
    recorder_->hand_over();
  }
  if (canary_.next_due()) {  // else the clock is not worth reading: this is done per copy
    while (const auto copy = canary_.take_due(sim_time(now_ns()))) {
      copies_.add(*copy);
    }
  }
  if (!copies_.empty()) {
    write_one_copy();
  }
  const std::int64_t now = now_ns();
  if (stamps_ && (awaited_ > 0 || held_ > 0) && now >= service_at_) {
    // Frames that the kernel lost on their way are asked for less and less often.
    service_ns_ =
        service_taps() ? kService_ns : std::clamp(2 * service_ns_, kService_ns, kSlowestService_ns);
    service_at_ = now_ns() + service_ns_;
  }
  if (!stamps_ && !copies_.empty()) {
    service_taps();
  }
  if (now >= housekeep_at_) {
    housekeep(owner, now);
  }
  if (copies_.empty()) {
    wait(owner, now_ns());
  }
}

/// Every frame with a stamp at or before an event is known before that event runs. The clock is
/// read first: what is stamped after that is later than any event that may run.
void LiveAir::run_due_events() {
  const std::int64_t patience_ns = now_ns() + kStampWrite_ns;
  for (int budget = kEventBudget; budget > 0; --budget) {
    const SimTime limit = sim_time(now_ns());
    drain_stamps();
    while (stamps_ && stamps_->reader().blocked() && now_ns() < patience_ns &&
           air_->next_event().value_or(SimTime::max()) <= limit) {
      relax();
      drain_stamps();
    }
    if (!air_->run_next(limit)) {
      return;
    }
  }
}

void LiveAir::wait(LiveOwner& owner, std::int64_t now) {
  if (const auto next = air_->next_event(); next && to_ns(*next) <= now) {
    return;
  }
  std::int64_t spin_from = housekeep_at_;
  const std::int64_t spin = now - slept_at_ > kLongSpin_ns ? kShortSpin_ns : kSpin_ns;
  for (const auto& release : {air_->next_delivery_bound(), canary_.next_due()}) {
    if (release) {
      spin_from = std::min(spin_from, to_ns(*release) - spin);
    }
  }
  if (stamps_ && awaited_ > 0) {
    spin_from = std::min(spin_from, service_at_ + kNotWorthSleeping_ns);
  }
  const std::int64_t timeout_ns = spin_from - now;
  const bool quiet = !stamps_ || stamps_->reader().empty();
  if (timeout_ns > kNotWorthSleeping_ns && quiet) {
    sleep(owner, timeout_ns);
    slept_at_ = now_ns();
  } else if (!stamps_) {
    sleep(owner, 0);
  } else {
    relax();
  }
}

void LiveAir::sleep(LiveOwner& owner, std::int64_t timeout_ns) {
  std::array<::epoll_event, 4> events{};
  const ::timespec timeout{.tv_sec = timeout_ns / 1'000'000'000,
                           .tv_nsec = timeout_ns % 1'000'000'000};
  const int count = ::epoll_pwait2(wake_.get(), events.data(), static_cast<int>(events.size()),
                                   &timeout, nullptr);
  if (count < 0 && errno != EINTR) {
    posix::throw_errno("epoll_pwait2");
  }
  for (int i = 0; i < count; ++i) {
    switch (static_cast<Wake>(events.at(static_cast<std::size_t>(i)).data.u32)) {
      case Wake::kOwner:
        stop_ = owner.should_stop();
        break;
      case Wake::kStamps:
        break;  // drained before the next event in any case
      case Wake::kTaps:
        service_taps();
        break;
    }
  }
}

void LiveAir::delivered(const Delivery& delivery) {
  const auto number = static_cast<std::uint32_t>(delivery.id);
  LiveFrame& frame = frames_[number];
  if (radio_memory_) {
    radio_memory_->publish_link(
        delivery.receiver, delivery.sender,
        {.received_dbm = static_cast<float>(delivery.received_power.value),
         .rate_kbps = delivery.rate_kbps,
         .sim_time_ms = static_cast<std::uint32_t>(to_ns(delivery.time) / kMillisecond)});
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
      release_lateness_.add(now_ns() - to_ns(copy.due));
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

void LiveAir::housekeep(LiveOwner& owner, std::int64_t now) {
  housekeep_at_ = now + kHousekeeping_ns;
  if (stamps_) {
    service_taps();  // frames that no stamp announced
    give_up_lost_frames(now);
  }
  const std::uint32_t slice =
      (air_->node_count() + kTicksPerPublication - 1) / kTicksPerPublication;
  publish(publish_next_, slice);
  publish_next_ = publish_next_ + slice >= air_->node_count() ? 0 : publish_next_ + slice;
  if (++ticks_ % kTicksPerPublication == 0) {
    publish_timing();
  }
  if (now >= beat_at_) {
    beat_at_ = now + kBeat_ns;
    owner.beat(sim_time(now));
  }
  stop_ = stop_ || owner.should_stop();
}

shm::RadioTally LiveAir::tally(std::uint32_t node) const {
  const Tally& air = air_->tally(node);
  const Port& port = ports_[node];
  return {.offered = air.offered + port.malformed + port.refused,
          .transmissions = air.transmissions,
          .retries = air.retries,
          .acknowledged = air.acknowledged,
          .received = air.received - port.lost_interface,
          .dropped_queue_full = air.dropped_queue_full + port.refused,
          .dropped_lifetime = air.dropped_lifetime,
          .dropped_retry_limit = air.dropped_retry_limit,
          .dropped_malformed = port.malformed + air.dropped_too_long,
          .dropped_before_air = port.before_air,
          .lost_below_floor = air.lost_below_floor,
          .lost_below_detection = air.lost_below_detection,
          .lost_noise = air.lost_noise,
          .lost_collision = air.lost_collision,
          .lost_interference = air.lost_interference,
          .lost_half_duplex = air.lost_half_duplex,
          .lost_jammed = air.lost_jammed,
          .lost_interface = port.lost_interface};
}

void LiveAir::publish(std::uint32_t first, std::uint32_t count) {
  if (!radio_memory_) {
    return;
  }
  const std::uint32_t end = std::min(first + count, air_->node_count());
  for (std::uint32_t node = first; node < end; ++node) {
    radio_memory_->publish(node, tally(node));
  }
}

void LiveAir::publish_timing() {
  if (!radio_memory_) {
    return;
  }
  radio_memory_->publish({.release_lateness_p50_ns = release_lateness_.quantile_ns(0.5),
                          .release_lateness_p99_ns = release_lateness_.quantile_ns(0.99),
                          .release_lateness_max_ns = release_lateness_.max_ns(),
                          .releases = release_lateness_.count(),
                          .clamps = clamp_.count(),
                          .events = air_->events()});
  radio_memory_->beat(to_ns(air_->now()));
}

proto::RadioReport LiveAir::report() const {
  proto::RadioReport report;
  report.set_send_stamps(stamps_ ? "tc-bpf" : "read");
  report.set_scheduler(scheduler_);
  *report.mutable_ingress_delay() = ipc::summary_of(ingress_delay_);
  *report.mutable_release_lateness() = ipc::summary_of(release_lateness_);
  report.set_clamps(clamp_.count());
  *report.mutable_clamp() = ipc::summary_of(clamp_);
  report.set_events(air_->events());
  report.set_cpu_s(cpu_s_);
  std::uint64_t before_air = 0;
  for (std::uint32_t node = 0; node < air_->node_count(); ++node) {
    before_air += ports_[node].before_air;
  }
  report.set_lost_before_air(before_air);
  report.set_unstamped(unstamped_);
  report.set_frames_not_logged(not_logged_);
  report.set_receptions_not_logged(receptions_not_logged_);
  if (recorder_ && recorder_->captures() != nullptr) {
    report.set_packets_captured(recorder_->captures()->packets());
    report.set_packets_not_captured(recorder_->captures()->packets_left_out());
  }
  if (recorder_ && recorder_->monitors() != nullptr) {
    report.set_packets_monitored(recorder_->monitors()->packets());
    report.set_packets_not_monitored(recorder_->monitors()->packets_left_out());
  }
  return report;
}

}  // namespace cuscus::netsim
