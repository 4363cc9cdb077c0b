#include "common/posix/scheduling.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

namespace cuscus::posix {

bool try_realtime_scheduling(int priority) noexcept {
  static_cast<void>(::prctl(PR_SET_TIMERSLACK, 1UL));
  const sched_param parameter{.sched_priority = priority};
  return ::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0;
}

void give_way_to_others() noexcept {
  const sched_param parameter{.sched_priority = 0};
  static_cast<void>(::sched_setscheduler(0, SCHED_BATCH, &parameter));
  constexpr int kNiceness = 10;
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNiceness));
}

std::string scheduling_class() {
  sched_param parameter{};
  static_cast<void>(::sched_getparam(0, &parameter));
  switch (::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) {
    case SCHED_FIFO:
      return "SCHED_FIFO " + std::to_string(parameter.sched_priority);
    case SCHED_RR:
      return "SCHED_RR " + std::to_string(parameter.sched_priority);
    case SCHED_BATCH:
      return "SCHED_BATCH";
    default:
      return "SCHED_OTHER";
  }
}

bool try_lock_memory() noexcept { return ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0; }

}  // namespace cuscus::posix
