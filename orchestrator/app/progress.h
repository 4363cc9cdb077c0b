#pragma once

#include <chrono>
#include <string>

namespace cuscus::orchestrator {

/// How far a run has got, on standard error: one line that is redrawn on a terminal, a plain line
/// every few seconds elsewhere.
class Progress {
 public:
  explicit Progress(std::chrono::nanoseconds duration);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Leaves the line, so that other output starts on a fresh one.
  ~Progress();

  /// `detail` is what else there is to say, such as "10 flying, late p99 0.04 ms".
  void show(std::chrono::nanoseconds elapsed, const std::string& detail);

 private:
  std::chrono::nanoseconds duration_;
  std::chrono::nanoseconds next_plain_{0};
  bool terminal_;
  bool drawn_{false};
};

}  // namespace cuscus::orchestrator
