#include "camera/view/frame_schedule.h"

#include <catch2/catch.hpp>

namespace cuscus::camera {
namespace {

TEST_CASE("pictures that are made in time are all made") {
  FrameSchedule schedule{50};
  for (std::uint64_t k = 0; k < 4; ++k) {
    CHECK(schedule.due_ns() == 50 * static_cast<std::int64_t>(k));
    schedule.begin(schedule.due_ns() + 1);
    schedule.finish(schedule.due_ns() - 20);
    CHECK(schedule.number() == k + 1);
  }
  CHECK(schedule.made() == 4);
  CHECK(schedule.skipped() == 0);
  CHECK(schedule.late() == 0);
}

TEST_CASE("what cannot be made in time is skipped and keeps its number") {
  FrameSchedule schedule{50};
  schedule.begin(0);
  schedule.finish(170);  // more than a period after 0: late

  schedule.begin(171);  // 50 and 100 are over, 150 is due

  CHECK(schedule.number() == 4);
  CHECK(schedule.due_ns() == 200);
  schedule.finish(190);
  CHECK(schedule.made() == 2);
  CHECK(schedule.late() == 1);
  CHECK(schedule.skipped() == 2);
}

TEST_CASE("a picture that is given up counts as skipped") {
  FrameSchedule schedule{50};
  schedule.begin(3);
  schedule.give_up();

  CHECK(schedule.due_ns() == 50);
  CHECK(schedule.made() == 0);
  CHECK(schedule.skipped() == 1);
}

}  // namespace
}  // namespace cuscus::camera
