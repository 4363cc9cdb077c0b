#pragma once

#include <cstdint>

namespace cuscus::camera {

/// When a camera's pictures are due: at 0 and every period after. A picture whose successor is due
/// before it was begun is skipped, never made up for.
class FrameSchedule {
 public:
  explicit FrameSchedule(std::int64_t period_ns) : period_ns_{period_ns} {}

  /// When the next picture is due [ns since the run began].
  [[nodiscard]] std::int64_t due_ns() const { return next_ * period_ns_; }
  /// A picture is begun, at or after due_ns().
  void begin(std::int64_t now_ns);
  /// It is there.
  void finish(std::int64_t now_ns);
  /// It cannot be made.
  void give_up() { ++skipped_; }

  /// Number of the picture that was begun last, from 1: skipped ones have one, too.
  [[nodiscard]] std::uint64_t number() const { return static_cast<std::uint64_t>(next_); }
  [[nodiscard]] std::uint64_t made() const { return made_; }
  [[nodiscard]] std::uint64_t skipped() const { return skipped_; }
  /// Of those made: more than a period after they were due.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  std::int64_t period_ns_;
  std::int64_t next_{0};
  std::int64_t begun_due_ns_{0};
  std::uint64_t made_{0};
  std::uint64_t skipped_{0};
  std::uint64_t late_{0};
};

}  // namespace cuscus::camera
