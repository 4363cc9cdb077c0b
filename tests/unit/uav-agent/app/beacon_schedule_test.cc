#include "uav-agent/app/beacon_schedule.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <vector>

namespace cuscus::agent {
namespace {

using std::chrono::milliseconds;

std::vector<SimTime> instants(std::uint64_t seed, std::uint32_t node, int count) {
  BeaconSchedule schedule{seed, node, milliseconds{50}};
  std::vector<SimTime> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(schedule.deadline());
    schedule.advance(schedule.deadline());
  }
  return result;
}

TEST_CASE("a node sends once in every period, with its own phase and a small jitter") {
  const auto sent = instants(1, 3, 200);

  CHECK(sent.front() >= SimTime{});
  CHECK(sent.front() < SimTime{milliseconds{53}});
  std::set<SimClock::duration> gaps;
  for (std::size_t i = 1; i < sent.size(); ++i) {
    const auto gap = sent[i] - sent[i - 1];
    // A jitter of 50 / 20 ms on either end.
    CHECK(std::chrono::abs(gap - milliseconds{50}) <= std::chrono::microseconds{2500});
    gaps.insert(gap);
  }
  CHECK(gaps.size() > 100);
  // Jitters do not add up.
  CHECK(sent.back() - sent.front() < 199 * milliseconds{50} + milliseconds{3});
}

TEST_CASE("a schedule is a function of seed and node") {
  CHECK(instants(1, 3, 20) == instants(1, 3, 20));
  CHECK(instants(1, 3, 20) != instants(1, 4, 20));
  CHECK(instants(2, 3, 20) != instants(1, 3, 20));
}

TEST_CASE("a fleet does not send in step") {
  // Of 100 nodes, at most a few share a fortieth of the period.
  std::vector<int> bins(40);
  for (std::uint32_t node = 0; node < 100; ++node) {
    const auto phase = instants(1, node, 1).front().time_since_epoch() % milliseconds{50};
    ++bins[static_cast<std::size_t>(phase / std::chrono::microseconds{1250})];
  }
  CHECK(*std::max_element(bins.begin(), bins.end()) <= 10);
}

TEST_CASE("beacons missed in a pause are not made up for") {
  BeaconSchedule schedule{1, 3, milliseconds{50}};
  const SimTime late = schedule.deadline() + milliseconds{100'000'000};

  schedule.advance(late);

  CHECK(schedule.deadline() > late);
  CHECK(schedule.deadline() < late + milliseconds{60});
}

TEST_CASE("control loops of a fleet are spread over their period") {
  std::set<SimTime> phases;
  for (std::uint32_t node = 0; node < 50; ++node) {
    const SimTime phase = control_phase(1, node, milliseconds{5});
    CHECK(phase >= SimTime{});
    CHECK(phase < SimTime{milliseconds{5}});
    phases.insert(phase);
  }
  CHECK(phases.size() == 50);
}

}  // namespace
}  // namespace cuscus::agent
