#include "netsim/capture/mac_frame.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <string_view>

#include "netsim/phy/standard.h"

namespace cuscus::netsim {
namespace {

using Octets = std::vector<std::uint8_t>;
using std::chrono::nanoseconds;

/// To 33:33:00:00:00:01 from 02:00:00:00:00:07, IPv6, with three octets.
const Octets kEthernet{0x33, 0x33, 0, 0, 0, 1, 2, 0, 0, 0, 0, 7, 0x86, 0xdd, 0x61, 0x62, 0x63};

Octets without_fcs(const Octets& octets) { return {octets.begin(), octets.end() - 4}; }

TEST_CASE("the frame check sequence is the CRC-32 of IEEE 802") {
  constexpr std::string_view kText{"123456789"};

  // The check value that catalogues of CRCs give for CRC-32/ISO-HDLC.
  CHECK(frame_check_sequence({reinterpret_cast<const std::uint8_t*>(kText.data()), kText.size()}) ==
        0xcbf43926);
}

TEST_CASE("a receiver that runs over a frame and its FCS finds the standard's remainder") {
  Octets octets;
  append_data_frame(octets, {.ethernet = kEthernet});

  // The FCS of a frame with its FCS is constant: the complement of 0xdebb20e3, which is 9.2.4.8's
  // c704dd7b with its bits in the order of transmission.
  CHECK(frame_check_sequence(octets) == (0xdebb20e3U ^ 0xffffffffU));
}

TEST_CASE("a data frame has the addresses and the type of its Ethernet frame") {
  Octets octets;

  append_data_frame(octets, {.ethernet = kEthernet,
                             .bssid = 0x0a0b0c0d0e0f,
                             .sequence = 0x1234,
                             .duration = nanoseconds{44'000}});

  CHECK(without_fcs(octets) == Octets{
                                   0x08, 0x00,                          // data, no flags
                                   44,   0,                             // us
                                   0x33, 0x33, 0,    0,    0,    1,     // DA
                                   2,    0,    0,    0,    0,    7,     // SA
                                   0x0a, 0x0b, 0x0c, 0x0d, 0x0e, 0x0f,  // BSSID
                                   0x40, 0x23,                          // 0x234, fragment 0
                                   0xaa, 0xaa, 3,    0,    0,    0,     // LLC, SNAP
                                   0x86, 0xdd, 0x61, 0x62, 0x63,
                               });
}

TEST_CASE("a data frame is as long as the PSDU that the air was busy with") {
  Octets ethernet(1514);
  std::iota(ethernet.begin(), ethernet.end(), std::uint8_t{0});
  Octets octets;

  append_data_frame(octets, {.ethernet = ethernet});

  CHECK(octets.size() == psdu_bytes_of_ethernet(1514));
}

TEST_CASE("a retry differs from its first attempt in the Retry bit and the FCS alone") {
  Octets first;
  Octets second;
  append_data_frame(first, {.ethernet = kEthernet, .sequence = 77});
  append_data_frame(second, {.ethernet = kEthernet, .sequence = 77, .retry = true});

  CHECK(second[1] == 0x08);
  second[1] = first[1];
  CHECK(without_fcs(first) == without_fcs(second));
}

TEST_CASE("control frames have the lengths and fields of clause 9.3.1") {
  constexpr std::uint64_t kReceiver = 0x020000000001;
  constexpr std::uint64_t kTransmitter = 0x020000000002;
  Octets ack;
  Octets cts;
  Octets rts;

  append_control_frame(ack, {.kind = ControlKind::kAck, .receiver = kReceiver});
  append_control_frame(
      cts, {.kind = ControlKind::kCts, .receiver = kReceiver, .duration = nanoseconds{299'001}});
  append_control_frame(rts, {.kind = ControlKind::kRts,
                             .receiver = kReceiver,
                             .transmitter = kTransmitter,
                             .duration = nanoseconds{40'000'000}});

  CHECK(ack.size() == kAckBytes);
  CHECK(cts.size() == kCtsBytes);
  CHECK(rts.size() == kRtsBytes);
  CHECK(without_fcs(ack) == Octets{0xd4, 0, 0, 0, 2, 0, 0, 0, 0, 1});
  // Parts of a microsecond count as one: 300 is 0x012c.
  CHECK(without_fcs(cts) == Octets{0xc4, 0, 0x2c, 0x01, 2, 0, 0, 0, 0, 1});
  // 32767 is the most that the field holds.
  CHECK(without_fcs(rts) == Octets{0xb4, 0, 0xff, 0x7f, 2, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2});
}

}  // namespace
}  // namespace cuscus::netsim
