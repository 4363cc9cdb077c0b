#include "orchestrator/app/hang_watch.h"

#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

namespace cuscus::orchestrator {
namespace {

/// Fields of /proc/pid/stat after the program's name: state is number 3, utime 14, stime 15.
constexpr int kUserTimeField = 14;
constexpr int kSystemTimeField = 15;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

std::int64_t number_of(std::string_view field) {
  std::int64_t value = 0;
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

}  // namespace

std::optional<ProcessActivity> parse_process_stat(std::string_view text, long ticks_per_s) {
  // The name is in parentheses and may hold any character: the last one closes it.
  const std::size_t close = text.rfind(')');
  if (close == std::string_view::npos || close + 2 >= text.size() || ticks_per_s <= 0) {
    return std::nullopt;
  }
  text.remove_prefix(close + 2);
  ProcessActivity activity{.state = text.front()};
  std::int64_t ticks = 0;
  for (int field = 3; field <= kSystemTimeField && !text.empty(); ++field) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (field == kUserTimeField || field == kSystemTimeField) {
      ticks += number_of(text.substr(0, end));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  activity.cpu = std::chrono::nanoseconds{ticks * kNanosecondsPerSecond / ticks_per_s};
  return activity;
}

bool HangWatch::hangs(Time last_heard, Time now) {
  const auto silent = now - last_heard;
  if (last_heard == heard_ && silent <= kSilenceLimit) {
    return false;
  }
  const auto seen = activity();
  if (!seen) {
    return false;  // it has ended, which is another matter
  }
  if (last_heard != heard_) {
    heard_ = last_heard;
    cpu_when_heard_ = seen->cpu;
    return false;
  }
  return is_hang(silent, seen->state, seen->cpu - cpu_when_heard_);
}

bool HangWatch::is_hang(std::chrono::nanoseconds silent, char state,
                        std::chrono::nanoseconds used) {
  const bool starved = state == 'R' && used < silent / 2;
  return silent > kSilenceLimit && !starved;
}

std::optional<ProcessActivity> HangWatch::activity() const {
  std::ifstream file{"/proc/" + std::to_string(pid_) + "/stat"};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  return parse_process_stat(text, ::sysconf(_SC_CLK_TCK));
}

}  // namespace cuscus::orchestrator
