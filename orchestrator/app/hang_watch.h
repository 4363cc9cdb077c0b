#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string_view>

namespace cuscus::orchestrator {

/// What proc(5), /proc/pid/stat says of a process.
struct ProcessActivity {
  char state{};  ///< 'R': runs or would run, 'S': sleeps, ...
  std::chrono::nanoseconds cpu{};
};

/// Of the text of /proc/pid/stat, with `ticks_per_s` clock ticks in a second; nothing when it is
/// none.
[[nodiscard]] std::optional<ProcessActivity> parse_process_stat(std::string_view text,
                                                                long ticks_per_s);

/// Tells a process that hangs from one that the host does not let run.
///
/// Both are silent. One that waits for what never comes sleeps; one in an endless loop uses the
/// processor all the time. One that is starved would run, and has hardly had the processor since it
/// was last heard: that is the host's fault, and the verdict's business.
class HangWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilenceLimit{5};

  explicit HangWatch(pid_t pid) : pid_{pid} {}

  /// To be called often; `last_heard` is when the process last gave a sign of life.
  [[nodiscard]] bool hangs(Time last_heard, Time now);

  /// The decision alone: `silent` since the last sign of life, `used` processor time since then.
  [[nodiscard]] static bool is_hang(std::chrono::nanoseconds silent, char state,
                                    std::chrono::nanoseconds used);

 private:
  [[nodiscard]] std::optional<ProcessActivity> activity() const;

  pid_t pid_;
  Time heard_{};
  std::chrono::nanoseconds cpu_when_heard_{0};
};

}  // namespace cuscus::orchestrator
