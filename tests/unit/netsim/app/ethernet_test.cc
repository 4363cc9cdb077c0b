#include "netsim/app/ethernet.h"

#include <catch2/catch.hpp>
#include <vector>

#include "netsim/mac/mac.h"

namespace cuscus::netsim {
namespace {

std::vector<std::uint8_t> frame(std::uint8_t first_octet, std::uint16_t type, std::size_t bytes) {
  std::vector<std::uint8_t> octets(bytes, 0);
  const std::vector<std::uint8_t> head{first_octet,
                                       2,
                                       3,
                                       4,
                                       5,
                                       6,
                                       0x02,
                                       0,
                                       0,
                                       0,
                                       0,
                                       1,
                                       static_cast<std::uint8_t>(type >> 8U),
                                       static_cast<std::uint8_t>(type & 0xffU)};
  for (std::size_t i = 0; i < head.size() && i < bytes; ++i) {
    octets[i] = head[i];
  }
  return octets;
}

bool crosses(std::uint16_t type, std::size_t bytes) {
  const auto octets = frame(0x02, type, bytes);
  return parse_ethernet(octets, static_cast<std::uint32_t>(bytes)).has_value();
}

TEST_CASE("addresses are read, and the group bit is the lowest of the first octet") {
  const auto unicast = parse_ethernet(frame(0x02, 0x0800, 60), 60);
  const auto multicast = parse_ethernet(frame(0x01, 0x0800, 60), 60);

  REQUIRE(unicast);
  CHECK(unicast->destination == 0x020203040506U);
  CHECK_FALSE(unicast->group);
  REQUIRE(multicast);
  CHECK(multicast->group);
}

TEST_CASE("runts, giants, 802.3 lengths and VLAN tags cannot cross the air") {
  CHECK_FALSE(crosses(0x8100, 60));
  CHECK_FALSE(crosses(0x88a8, 60));
  CHECK_FALSE(crosses(0x0800, 0));
  CHECK_FALSE(crosses(0x0800, 13));
  CHECK(crosses(0x0800, 14));
  // MSDU of 2304 B: 8 B of LLC/SNAP and 2296 B of payload.
  CHECK(crosses(0x0800, 14 + 2296));
  CHECK_FALSE(crosses(0x0800, 14 + 2297));
  CHECK_FALSE(crosses(0x05ff, 60));
  CHECK(crosses(0x0600, 60));
}

TEST_CASE("a stamp's head is enough to parse a longer frame") {
  const auto octets = frame(0x02, 0x0800, 48);

  CHECK(parse_ethernet(octets, 1514).has_value());
}

TEST_CASE("the priority is the precedence in the DSCP of IPv4 and IPv6, and 0 for the rest") {
  const auto priority = [](std::uint16_t type, std::uint8_t first, std::uint8_t second) {
    auto octets = frame(0x02, type, 60);
    octets[14] = first;
    octets[15] = second;
    return int{parse_ethernet(octets, 60).value().priority};
  };

  // DSCP 46 (expedited forwarding) is 101 110, DSCP 8 (CS1) 001 000, DSCP 56 (CS7) 111 000. Behind
  // it come two bits of congestion notification.
  CHECK(priority(0x0800, 0x45, 46 << 2) == 5);
  CHECK(priority(0x0800, 0x45, 8 << 2 | 3) == 1);
  CHECK(priority(0x0800, 0x45, 56 << 2) == 7);
  CHECK(priority(0x0800, 0x45, 7 << 2 | 3) == 0);
  // IPv6: four bits of version, eight of traffic class, twenty of flow label.
  CHECK(priority(0x86dd, 0x60 | (46 << 2) >> 4, 0x8f) == 5);
  CHECK(priority(0x86dd, 0x6e, 0x00) == 7);
  CHECK(priority(0x86dd, 0x61, 0xff) == 0);
  CHECK(priority(0x0806, 0xff, 0xff) == 0);
  CHECK(parse_ethernet(frame(0x02, 0x0800, 14), 14).value().priority == 0);
}

TEST_CASE("the address book knows nodes, groups and strangers") {
  AddressBook book;
  CHECK(book.add(0x020203040506U, 5));
  CHECK_FALSE(book.add(0x020203040506U, 6));

  CHECK(book.destination({.destination = 0x020203040506U, .group = false}) == 5);
  CHECK(book.destination({.destination = 0x0aU, .group = false}) == kNobody);
  CHECK(book.destination({.destination = 0xffffffffffffU, .group = true}) == kGroup);
}

}  // namespace
}  // namespace cuscus::netsim
