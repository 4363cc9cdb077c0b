#include "uav-agent/sdk/periodic_timer.h"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace cuscus::sdk {
namespace {

using std::chrono::milliseconds;

constexpr SimTime at(int ms) { return SimTime{milliseconds{ms}}; }

TEST_CASE("deadlines are multiples of the period, however late a round is") {
  PeriodicTimer timer{milliseconds{5}, at(2)};

  CHECK(timer.deadline() == at(2));
  CHECK_FALSE(timer.due(at(1)));
  CHECK(timer.advance(at(1)) == 0);
  CHECK(timer.deadline() == at(2));
  CHECK(timer.advance(at(2)) == 0);
  CHECK(timer.deadline() == at(7));
  CHECK(timer.advance(at(11)) == 0);
  CHECK(timer.deadline() == at(12));
}

TEST_CASE("skipped deadlines are counted and not made up for") {
  PeriodicTimer timer{milliseconds{5}};

  CHECK(timer.advance(at(17)) == 3);
  CHECK(timer.deadline() == at(20));
}

TEST_CASE("a timer without a period is an error") {
  CHECK_THROWS_AS(PeriodicTimer{SimClock::duration::zero()}, std::invalid_argument);
}

}  // namespace
}  // namespace cuscus::sdk
