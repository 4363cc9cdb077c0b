#include "orchestrator/app/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "orchestrator/app/print.h"

namespace cuscus::orchestrator {
namespace {

constexpr std::chrono::seconds kPlainInterval{5};
constexpr int kBarCells = 30;

double seconds(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double>{duration}.count();
}

}  // namespace

Progress::Progress(std::chrono::nanoseconds duration)
    : duration_{duration}, terminal_{::isatty(STDERR_FILENO) == 1} {}

void Progress::show(std::chrono::nanoseconds elapsed, const std::string& detail) {
  const double share = std::clamp(seconds(elapsed) / seconds(duration_), 0.0, 1.0);
  if (terminal_) {
    const int filled = static_cast<int>(share * kBarCells);
    print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:5.1f}/{:.0f} s  {}", "", filled, "",
          kBarCells - filled, seconds(elapsed), seconds(duration_), detail);
    std::fflush(stderr);
    drawn_ = true;
  } else if (elapsed >= next_plain_) {
    next_plain_ = elapsed + kPlainInterval;
    print(stderr, "{:.0f}/{:.0f} s  {}\n", seconds(elapsed), seconds(duration_), detail);
  }
}

Progress::~Progress() {
  if (drawn_) {
    std::fputc('\n', stderr);
  }
}

}  // namespace cuscus::orchestrator
