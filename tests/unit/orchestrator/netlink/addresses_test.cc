#include "orchestrator/netlink/addresses.h"

#include <catch2/catch.hpp>

namespace cuscus::netlink {
namespace {

TEST_CASE("a network's broadcast address has a host part of ones") {
  CHECK(broadcast_of({.address = {10, 0, 3, 4}, .length = 8}) == Ipv4Address{10, 255, 255, 255});
  CHECK(broadcast_of({.address = {10, 0, 3, 4}, .length = 22}) == Ipv4Address{10, 0, 3, 255});
  CHECK(broadcast_of({.address = {10, 0, 3, 4}, .length = 30}) == Ipv4Address{10, 0, 3, 7});
  CHECK(broadcast_of({.address = {10, 0, 3, 4}, .length = 32}) == Ipv4Address{10, 0, 3, 4});
  CHECK(broadcast_of({.address = {10, 0, 3, 4}, .length = 0}) == Ipv4Address{255, 255, 255, 255});
}

TEST_CASE("an address is written with dots") {
  CHECK(to_string(Ipv4Address{10, 0, 255, 1}) == "10.0.255.1");
}

}  // namespace
}  // namespace cuscus::netlink
