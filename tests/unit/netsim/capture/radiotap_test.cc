#include "netsim/capture/radiotap.h"

#include <catch2/catch.hpp>
#include <limits>

namespace cuscus::netsim {
namespace {

using Octets = std::vector<std::uint8_t>;

// Octet by octet from radiotap.org: version 0, pad, length, bits of the fields, fields in the order
// of their bits, each aligned to its size.

TEST_CASE("the radiotap header of a received frame has time, rate, channel, signal and noise") {
  Octets octets;

  append_radiotap(octets,
                  {.mac_time_us = 0x0102030405060708,
                   .rate_kbps = 54'000,
                   .channel = radiotap_channel(2.437e9, 20e6, ModulationClass::kOfdm),
                   .received = RadiotapHeader::Received{.signal_dbm = -60.4, .noise_dbm = -93.97}});

  CHECK(octets == Octets{
                      0,    0,    24,   0,                             // length 24
                      0x6f, 0,    0,    0,                             // bits 0-3, 5, 6
                      0x08, 0x07, 0x06, 0x05, 0x04, 0x03, 0x02, 0x01,  // TSFT
                      0x10,                                            // FCS at end
                      108,                                             // of 500 kb/s
                      0x85, 0x09, 0xc0, 0,                             // 2437 MHz; OFDM, 2.4 GHz
                      0xc4, 0xa2,                                      // -60 dBm, -94 dBm
                  });
}

TEST_CASE("the radiotap header of an own transmission has power, TX flags and retries") {
  Octets octets{0xee};  // alignment counts from the header's beginning

  append_radiotap(octets, {.mac_time_us = 1,
                           .short_preamble = true,
                           .rate_kbps = 5'500,
                           .channel = radiotap_channel(2.412e9, 22e6, ModulationClass::kDsss),
                           .transmitted = RadiotapHeader::Transmitted{
                               .power_dbm = 16.0, .no_ack = true, .retries = 3}});

  CHECK(octets == Octets{
                      0xee,                             // what was there before
                      0,    0,    27,   0,              // length 27
                      0x0f, 0x84, 2,    0,              // bits 0-3, 10, 15, 17
                      1,    0,    0,    0, 0, 0, 0, 0,  // TSFT
                      0x12,                             // short preamble, FCS at end
                      11,                               // of 500 kb/s
                      0x6c, 0x09, 0xa0, 0,              // 2412 MHz; CCK, 2.4 GHz
                      16,   0,                          // dBm; to the next even offset
                      0x08, 0,                          // no ACK expected
                      3,                                // retries
                  });
}

TEST_CASE("levels that 8 bits do not hold are clamped, and a bad FCS is said") {
  Octets octets;

  append_radiotap(
      octets, {.bad_fcs = true,
               .received = RadiotapHeader::Received{
                   .signal_dbm = -std::numeric_limits<double>::infinity(), .noise_dbm = 200.0}});

  CHECK(octets[16] == 0x50);
  CHECK(octets[22] == 0x80);  // -128
  CHECK(octets[23] == 0x7f);  // 127
}

TEST_CASE("802.11p is a half-rate channel of the 5 GHz band") {
  const RadiotapChannel channel = radiotap_channel(5.89e9, 10e6, ModulationClass::kOfdm);

  CHECK(channel.frequency_mhz == 5890);
  CHECK(channel.flags == (0x0040 | 0x0100 | 0x4000));
}

TEST_CASE("a carrier outside both bands names none") {
  CHECK(radiotap_channel(868e6, 20e6, ModulationClass::kOfdm).flags == 0x0040);
}

}  // namespace
}  // namespace cuscus::netsim
