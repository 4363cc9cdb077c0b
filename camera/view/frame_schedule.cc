#include "camera/view/frame_schedule.h"

namespace cuscus::camera {

void FrameSchedule::begin(std::int64_t now_ns) {
  const std::int64_t current = now_ns / period_ns_;
  if (current > next_) {
    skipped_ += static_cast<std::uint64_t>(current - next_);
    next_ = current;
  }
  begun_due_ns_ = due_ns();
  ++next_;
}

void FrameSchedule::finish(std::int64_t now_ns) {
  ++made_;
  late_ += now_ns > begun_due_ns_ + period_ns_ ? 1 : 0;
}

}  // namespace cuscus::camera
