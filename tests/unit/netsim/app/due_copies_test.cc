#include "netsim/app/due_copies.h"

#include <catch2/catch.hpp>
#include <vector>

namespace cuscus::netsim {
namespace {

DueCopy copy(std::uint32_t frame, std::int64_t due_ns) {
  return {.frame = frame, .receiver = 0, .due = sim_time(due_ns)};
}

std::vector<std::uint32_t> frames(DueCopies& copies) {
  std::vector<std::uint32_t> frames;
  while (!copies.empty()) {
    frames.push_back(copies.take_first().frame);
  }
  return frames;
}

TEST_CASE("copies come out in the order in which they are due") {
  DueCopies copies;
  copies.add(copy(1, 100));
  copies.add(copy(2, 200));
  copies.add(copy(3, 300));

  // Two frames whose payload came late, and one that is due with another.
  copies.add(copy(4, 50));
  copies.add(copy(5, 250));
  copies.add(copy(6, 200));

  CHECK(frames(copies) == std::vector<std::uint32_t>{4, 1, 2, 6, 5, 3});
}

TEST_CASE("late payloads of several frames keep the order of their frames") {
  DueCopies copies;
  copies.add(copy(9, 900));
  for (std::uint32_t frame = 1; frame <= 3; ++frame) {
    copies.add(copy(frame, 100 * frame));
  }

  CHECK(frames(copies) == std::vector<std::uint32_t>{1, 2, 3, 9});
}

}  // namespace
}  // namespace cuscus::netsim
