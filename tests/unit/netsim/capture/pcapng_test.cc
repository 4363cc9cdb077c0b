#include "netsim/capture/pcapng.h"

#include <catch2/catch.hpp>

namespace cuscus::netsim::pcapng {
namespace {

using Octets = std::vector<std::uint8_t>;

// Octet by octet from the format's draft, section 4: type, length, body, options, length.

TEST_CASE("a section header has the byte order, version 1.0 and an open length") {
  Octets octets;

  append_section_header(octets, "cuscus");

  CHECK(octets == Octets{
                      0x0a, 0x0d, 0x0d, 0x0a, 44, 0,    0,    0,    0x4d, 0x3c, 0x2b,
                      0x1a, 1,    0,    0,    0,  0xff, 0xff, 0xff, 0xff, 0xff, 0xff,
                      0xff, 0xff, 4,    0,    6,  0,    'c',  'u',  's',  'c',  'u',
                      's',  0,    0,    0,    0,  0,    0,    44,   0,    0,    0,
                  });
}

TEST_CASE("an interface has link type 127, its name, and counts nanoseconds") {
  Octets octets;

  append_interface(octets, {.name = "uav3", .description = "radio", .snap_length = 300});

  CHECK(octets == Octets{
                      1, 0, 0,   0,   52,  0,   0, 0, 127, 0, 0,   0,   0x2c, 1,   0,   0, 2, 0,
                      4, 0, 'u', 'a', 'v', '3', 3, 0, 5,   0, 'r', 'a', 'd',  'i', 'o', 0, 0, 0,
                      9, 0, 1,   0,   9,   0,   0, 0, 0,   0, 0,   0,   52,   0,   0,   0,
                  });
}

TEST_CASE("a packet has its time in two halves, both lengths, direction and comment") {
  const Octets frame{1, 2, 3, 4, 5};
  Octets octets;

  append_packet(octets, {.time_ns = 0x1122334455667788,
                         .octets = frame,
                         .original_bytes = 9,
                         .outbound = true,
                         .comment = "why"});

  CHECK(octets == Octets{
                      6,    0,    0,    0,    60,   0,   0, 0, 0, 0, 0, 0,  0x44, 0x33, 0x22,
                      0x11, 0x88, 0x77, 0x66, 0x55, 5,   0, 0, 0, 9, 0, 0,  0,    1,    2,
                      3,    4,    5,    0,    0,    0,   2, 0, 4, 0, 2, 0,  0,    0,    1,
                      0,    3,    0,    'w',  'h',  'y', 0, 0, 0, 0, 0, 60, 0,    0,    0,
                  });
}

TEST_CASE("a packet that came in has no comment unless there is one") {
  Octets octets;

  append_packet(octets, {.time_ns = 1, .octets = {}, .original_bytes = 0, .comment = {}});

  CHECK(octets.size() == 44);
  CHECK(octets[32] == 1);  // inbound
}

TEST_CASE("statistics say how many packets there were, and how many of them are missing") {
  Octets octets;

  append_statistics(octets, {.time_ns = 7, .captured = 500, .dropped = 12});

  CHECK(octets == Octets{
                      5,  0, 0, 0, 52, 0, 0, 0, 0, 0, 0, 0, 0,  0, 0, 0, 7, 0,
                      0,  0, 4, 0, 8,  0, 0, 2, 0, 0, 0, 0, 0,  0, 5, 0, 8, 0,
                      12, 0, 0, 0, 0,  0, 0, 0, 0, 0, 0, 0, 52, 0, 0, 0,
                  });
}

}  // namespace
}  // namespace cuscus::netsim::pcapng
