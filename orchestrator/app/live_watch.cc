// What a run looks after while it waits: signals, its components, its own lateness.
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "orchestrator/app/live_run.h"
#include "orchestrator/app/run_trouble.h"
#include "orchestrator/results/fidelity.h"

namespace cuscus::orchestrator {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// For callbacks in a row.
constexpr milliseconds kServiceTurn{10};

}  // namespace

void LiveRun::watch_signals() {
  signals_.async_wait([this](const boost::system::error_code& error, int number) {
    if (error) {
      return;
    }
    if (signal_number_ == 0) {
      signal_number_ = number;
    }
    ++signals_seen_;
    watch_signals();
  });
}

void LiveRun::check_trouble() const {
  if (signal_number_ != 0) {
    throw RunInterrupted{};
  }
  for (const Service* const service : services()) {
    if (const auto trouble = service->trouble(); !trouble.empty()) {
      throw RunFailed{trouble};
    }
  }
  if (crew_ && !crew_->trouble().empty()) {
    throw RunFailed{crew_->trouble()};
  }
}

void LiveRun::check_heartbeats() {
  for (Service* const service : services()) {
    if (service->hangs()) {
      throw RunFailed{fmt::format("{} hangs: no heartbeat for {} s", service->component().name(),
                                  HangWatch::kSilenceLimit.count())};
    }
  }
}

void LiveRun::check_validity() {
  const auto& radio = netsim_->component().report_so_far();
  const auto& world = world_->component().report_so_far();
  if (lost_validity_ || !radio || !world) {
    return;
  }
  FidelityInputs so_far;
  so_far.radio = radio->radio();
  so_far.world = world->world();
  so_far.longest_supervision_gap = longest_gap_;
  so_far.realtime_wanted = plan_.realtime;
  so_far.flown_share =
      std::clamp(sim_time_s() / std::chrono::duration<double>{plan_.duration}.count(), 1e-9, 1.0);
  if (const auto reason = lost_validity(so_far)) {
    lost_validity_ = true;
    if (plan_.on_late == scenario::OnLate::kStop) {
      throw RunLate{"cannot become VALID any more: " + *reason};
    }
    spdlog::warn("since {:.1f} s the run cannot become VALID any more: {}", sim_time_s(), *reason);
  }
}

void LiveRun::await(const std::function<std::string()>& what, milliseconds limit,
                    const std::function<bool()>& done) {
  const auto deadline = steady_clock::now() + limit;
  while (!done()) {
    check_trouble();
    if (steady_clock::now() >= deadline) {
      throw RunFailed{fmt::format("waited {} s in vain for {}", limit.count() / 1000, what())};
    }
    wait_step(std::min(deadline, steady_clock::now() + milliseconds{100}));
  }
}

bool LiveRun::settle(milliseconds limit, const std::function<bool()>& done) {
  const auto deadline = steady_clock::now() + limit;
  while (!done() && steady_clock::now() < deadline && signals_seen_ < 2) {
    wait_step(deadline);
  }
  return done();
}

void LiveRun::wait_step(steady_clock::time_point deadline) {
  loop_.restart();
  loop_.run_one_until(deadline);
  serve();  // also after the deadline, such as when this process was stopped for a while
}

void LiveRun::serve() {
  // Whoever floods its control socket always has something ready.
  const auto enough = steady_clock::now() + kServiceTurn;
  while (loop_.poll_one() > 0 && steady_clock::now() < enough) {
  }
}

}  // namespace cuscus::orchestrator
