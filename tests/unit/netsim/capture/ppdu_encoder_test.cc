#include "netsim/capture/ppdu_encoder.h"

#include <array>
#include <catch2/catch.hpp>
#include <chrono>

#include "netsim/capture/mac_frame.h"

namespace cuscus::netsim {
namespace {

using Octets = std::vector<std::uint8_t>;
using Kind = MacFrame::Kind;
using std::chrono::microseconds;
using std::chrono::nanoseconds;

constexpr std::size_t kReceivedHeader = 24;
constexpr std::size_t kOwnHeader = 27;

/// From node 0 to node 1.
const Octets kDataFrame{2, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 1, 8, 0, 'd', 'a', 't', 'a'};

PpduEncoder encoder(const std::string& standard = "802.11g", const std::string& mac = "dcf") {
  AirParameters air;
  air.standard = standard;
  air.mac = mac;
  air.nodes.assign(2, AirNode{.tx_power = {17.0}});
  return {air, {0x020000000001, 0x020000000002}};
}

/// Node 0's second attempt of a frame to node 1, on the air from 1 ms to 1.026 ms.
PpduRecord retry() {
  PpduRecord record{.node = 0, .own = true};
  record.ppdu = {.frame = {.kind = Kind::kData, .sender = 0, .receiver = 1, .sequence = 5},
                 .mode = &ieee80211g().mode(54'000),
                 .attempt = 2,
                 .begins = SimTime{} + microseconds{1'000},
                 .ends = SimTime{} + microseconds{1'036}};
  return record;
}

Octets encoded(const PpduEncoder& encoder, const PpduRecord& record) {
  Octets octets;
  encoder.append(octets, record, kDataFrame);
  return octets;
}

std::uint64_t mac_time_us(const Octets& octets) {
  std::uint64_t time_us = 0;
  for (std::size_t i = 8; i > 0; --i) {
    time_us = time_us << 8U | octets[7 + i];
  }
  return time_us;
}

TEST_CASE("an own retry has power, retries, the Retry bit, and the time of its MPDU") {
  const Octets octets = encoded(encoder(), retry());

  CHECK(octets[22] == 17);
  CHECK(octets[24] == 0);  // an ACK is expected
  CHECK(octets[26] == 1);
  CHECK(octets[kOwnHeader] == 0x08);
  CHECK(octets[kOwnHeader + 1] == 0x08);
  CHECK(mac_time_us(octets) == 1'020);  // behind 16 us of training and 4 us of SIGNAL field
  constexpr std::uint32_t kEthernetBytes = 18;
  CHECK(octets.size() == kOwnHeader + psdu_bytes_of_ethernet(kEthernetBytes));
}

TEST_CASE("a received frame has its time where it was received") {
  PpduRecord record = retry();
  record.own = false;
  record.node = 1;
  // It took 3 us to get there.
  record.reception = {.receiver = 1, .time = record.ppdu.ends + microseconds{3}, .power = {-71.6}};

  const Octets octets = encoded(encoder(), record);

  CHECK(mac_time_us(octets) == 1'023);
  CHECK(static_cast<std::int8_t>(octets[22]) == -72);
  CHECK(static_cast<std::int8_t>(octets[23]) == -94);
  CHECK(octets[16] == 0x10);
  CHECK(record.time() == SimTime{} + microseconds{1'039});
  const std::span<const std::uint8_t> frame = std::span{octets}.subspan(kReceivedHeader);
  CHECK(frame_check_sequence(frame) == (0xdebb20e3U ^ 0xffffffffU));
}

TEST_CASE("an ACK is addressed to whom it answers, at its own rate, and expects no ACK") {
  PpduRecord record{.node = 1, .own = true};
  record.ppdu = {.frame = {.kind = Kind::kAck, .sender = 1, .receiver = 0},
                 .mode = &ieee80211g().mode(24'000)};

  const Octets octets = encoded(encoder(), record);

  CHECK(octets[17] == 48);
  CHECK(octets[24] == 0x08);
  CHECK(Octets(octets.begin() + kOwnHeader, octets.end() - 4) ==
        Octets{0xd4, 0, 0, 0, 2, 0, 0, 0, 0, 1});
}

TEST_CASE("an RTS to nobody's address has the address that the sender's program wrote") {
  PpduRecord record{.node = 0, .own = true};
  record.ppdu = {.frame = {.kind = Kind::kRts, .sender = 0, .receiver = kNobody},
                 .mode = &ieee80211g().mode(24'000)};

  const Octets octets = encoded(encoder(), record);

  CHECK(Octets(octets.begin() + kOwnHeader + 4, octets.end() - 4) ==
        Octets{2, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 1});
}

TEST_CASE("what failed has a wrong FCS, the flag that says so, and a comment with the cause") {
  PpduRecord record = retry();
  record.own = false;
  record.node = 1;
  record.reception = {.receiver = 1,
                      .time = record.ppdu.ends,
                      .cause = LossCause::kInterference,
                      .power = {-70.0},
                      .sinr = {3.21},
                      .interferer = 0};
  const std::array<std::string, 2> names{"uav0", "uav1"};

  const Octets octets = encoded(encoder(), record);

  CHECK(octets[16] == 0x50);
  Octets frame(octets.begin() + kReceivedHeader, octets.end());
  CHECK(frame_check_sequence(frame) != (0xdebb20e3U ^ 0xffffffffU));
  for (std::size_t i = frame.size() - 4; i < frame.size(); ++i) {
    frame[i] = static_cast<std::uint8_t>(~frame[i]);
  }
  CHECK(frame_check_sequence(frame) == (0xdebb20e3U ^ 0xffffffffU));
  CHECK(comment_of(record, names) == "lost: interference, SINR 3.2 dB, uav0 was on the air");
  record.reception.interferer = kNoSender;
  record.reception.cause = LossCause::kNoise;
  CHECK(comment_of(record, names) == "lost: noise, SINR 3.2 dB");
  CHECK(comment_of(retry(), names).empty());
}

TEST_CASE("802.11p has the wildcard BSSID, and TDMA expects no ACK") {
  PpduRecord record = retry();
  record.ppdu.mode = &standard_of("802.11p").mode(6'000);

  const Octets outside = encoded(encoder("802.11p"), record);
  const Octets slotted = encoded(encoder("802.11g", "tdma"), retry());

  constexpr std::size_t kBssid = kOwnHeader + 16;
  CHECK(Octets(outside.begin() + kBssid, outside.begin() + kBssid + 6) == Octets(6, 0xff));
  CHECK(mac_time_us(outside) == 1'040);  // all times of 10 MHz are twice as long
  CHECK(Octets(slotted.begin() + kBssid, slotted.begin() + kBssid + 6) ==
        Octets{2, 0x63, 0x75, 0x73, 0xff, 0xff});
  CHECK(outside[24] == 0);
  CHECK(slotted[24] == 0x08);
}

TEST_CASE("the short preamble of DSSS is said, and the long one is not") {
  PpduRecord record = retry();
  record.ppdu.mode = &standard_of("802.11b", DsssPreamble::kShort).mode(11'000);
  CHECK(encoded(encoder("802.11b"), record)[16] == 0x12);

  record.ppdu.mode = &standard_of("802.11b", DsssPreamble::kLong).mode(11'000);
  CHECK(encoded(encoder("802.11b"), record)[16] == 0x10);
}

}  // namespace
}  // namespace cuscus::netsim
