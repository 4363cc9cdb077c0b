#pragma once

#include <cstdint>
#include <string>

namespace cuscus::world {

/// What the loop needs of the machine that it runs on; a test brings its own.
class StepHost {
 public:
  virtual ~StepHost() = default;

  /// Called once, when everything is mapped and before the first step: makes the thread as prompt
  /// as the machine allows. `realtime_priority` 0 asks for no real-time scheduling.
  virtual void prepare(int realtime_priority) = 0;

  /// The clock of the run: CLOCK_MONOTONIC [ns].
  [[nodiscard]] virtual std::int64_t now_ns() = 0;
  /// Returns when the clock has reached `deadline_ns`, at once when it has passed.
  virtual void sleep_until_ns(std::int64_t deadline_ns) = 0;

  /// What the thread runs under, for the report.
  [[nodiscard]] virtual std::string scheduler() const = 0;
};

/// The Linux machine under us.
class LinuxStepHost final : public StepHost {
 public:
  void prepare(int realtime_priority) override;
  [[nodiscard]] std::int64_t now_ns() override;
  void sleep_until_ns(std::int64_t deadline_ns) override;
  [[nodiscard]] std::string scheduler() const override;
};

}  // namespace cuscus::world
