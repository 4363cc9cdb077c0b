#include "world/app/step_host.h"

#include <sys/prctl.h>

#include "common/log/log.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/scheduling.h"

namespace cuscus::world {

void LinuxStepHost::prepare(int realtime_priority) {
  // Without it the kernel may round a sleep of an ordinary thread up by 50 us.
  static_cast<void>(::prctl(PR_SET_TIMERSLACK, 1UL));
  if (!posix::try_lock_memory()) {
    spdlog::info("memory cannot be locked; page faults may make steps late");
  }
  if (realtime_priority > 0 && !posix::try_realtime_scheduling(realtime_priority)) {
    spdlog::warn("no SCHED_FIFO {} here; steps may be late on a busy machine", realtime_priority);
  }
}

std::int64_t LinuxStepHost::now_ns() { return posix::monotonic_now_ns(); }

void LinuxStepHost::sleep_until_ns(std::int64_t deadline_ns) {
  posix::sleep_until_monotonic(deadline_ns);
}

std::string LinuxStepHost::scheduler() const { return posix::scheduling_class(); }

}  // namespace cuscus::world
