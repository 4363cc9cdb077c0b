#pragma once

#include <string>

namespace cuscus::posix {

/// Asks for SCHED_FIFO at `priority` for the calling thread, with the smallest timer slack. False
/// when the kernel refuses, which is normal without CAP_SYS_NICE.
bool try_realtime_scheduling(int priority) noexcept;

/// Lets everybody else go first who wants the processor: SCHED_BATCH at nice 10,
/// for the calling thread and those that it will start.
void give_way_to_others() noexcept;

/// What the calling thread runs under: "SCHED_FIFO 50", "SCHED_BATCH", "SCHED_OTHER".
[[nodiscard]] std::string scheduling_class();

/// Locks all memory, present and future; false when refused.
bool try_lock_memory() noexcept;

}  // namespace cuscus::posix
