#include "netsim/app/canary_link.h"

#include <catch2/catch.hpp>
#include <chrono>

namespace cuscus::netsim {
namespace {

using namespace std::chrono_literals;

TEST_CASE("what enters one end of the canary's link is due at the other after its delay") {
  CanaryLink link{3, 300us};

  link.sent(7, 3, 1'000'000);
  link.sent(8, 4, 1'100'000);

  CHECK(link.next_due() == sim_time(1'300'000));
  CHECK_FALSE(link.take_due(sim_time(1'299'999)));
  const auto first = link.take_due(sim_time(1'300'000));
  REQUIRE(first);
  CHECK(first->frame == 7);
  CHECK(first->receiver == 4);
  CHECK(first->due == sim_time(1'300'000));
  CHECK_FALSE(link.take_due(sim_time(1'300'000)));
  const auto second = link.take_due(sim_time(2'000'000));
  REQUIRE(second);
  CHECK(second->receiver == 3);
  CHECK_FALSE(link.next_due());
}

TEST_CASE("the canary's ports lie behind those of the nodes, and without a delay there are none") {
  CHECK(CanaryLink{3, 300us}.port_count() == 2);
  CHECK(CanaryLink{3, 0us}.port_count() == 0);
  CHECK_FALSE(CanaryLink{3, 300us}.has(2));
  CHECK(CanaryLink{3, 300us}.has(3));
}

}  // namespace
}  // namespace cuscus::netsim
