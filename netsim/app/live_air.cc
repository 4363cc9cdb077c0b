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

constexpr std::int64_t kSlowestService_ns = kMillisecond;
/// Events run in a row while a copy waits to be written.
constexpr int kEventBudget = 64;
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
  if (const std::int64_t late_ns = now_ns(); late_ns > 0) {
    spdlog::warn("the air begins {:.1f} ms after the run: what was sent before is lost",
                 static_cast<double>(late_ns) / kMillisecond);
  }
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

}  // namespace cuscus::netsim
