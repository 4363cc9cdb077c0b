#include <linux/if_packet.h>

#include <catch2/catch.hpp>
#include <string>

#include "tests/netns/tap_node.h"

namespace cuscus::netsim {
namespace {

TEST_CASE("broadcast datagrams reach every other node once, with their contents") {
  TapFleet fleet{3};
  constexpr std::uint64_t kDatagrams = 40;

  for (std::uint64_t i = 0; i < kDatagrams; ++i) {
    const auto from = static_cast<std::uint32_t>(i % 3);
    const std::string text = "datagram " + std::to_string(i);
    fleet.send(from, test_address(255), text);
    for (std::uint32_t node = 0; node < 3; ++node) {
      REQUIRE(fleet.receive(node) == text);  // the sender's own kernel gives it a copy
    }
  }
  fleet.stop();

  std::uint64_t offered = 0;
  std::uint64_t received = 0;
  for (std::uint32_t node = 0; node < 3; ++node) {
    const shm::RadioTally tally = fleet.air().tally(node);
    offered += tally.offered;
    received += tally.received;
    CHECK(tally.transmissions == tally.offered);
    CHECK(tally.lost_interface == 0);
    CHECK(fleet.memory().tally(node)->received == tally.received);
    CHECK(fleet.memory().link(node, (node + 1) % 3)->received_dbm > -60.0F);
  }
  CHECK(offered == kDatagrams);
  CHECK(received == 2 * kDatagrams);
  CHECK(fleet.air().report().release_lateness().count() == 2 * kDatagrams);
  CHECK(fleet.air().report().send_stamps() == "read");
}

TEST_CASE("individually addressed datagrams are resolved, acknowledged and answered") {
  TapFleet fleet{3};

  for (int i = 0; i < 10; ++i) {
    fleet.send(0, test_address(3), "question " + std::to_string(i));
    REQUIRE(fleet.receive(2) == "question " + std::to_string(i));
    fleet.send(2, test_address(1), "answer " + std::to_string(i));
    REQUIRE(fleet.receive(0) == "answer " + std::to_string(i));
  }
  fleet.stop();

  // Ten datagrams each way and node 2's ARP reply (requests are group frames), less the last
  // answer, whose ACK we did not wait for.
  CHECK(fleet.air().tally(0).acknowledged >= 10);
  CHECK(fleet.air().tally(2).acknowledged >= 10);
  CHECK(fleet.air().tally(0).dropped_retry_limit == 0);
  CHECK(fleet.air().report().release_lateness().p50_ns() >= 0);
}

TEST_CASE("a copy is not released before the frame's time on the air is over") {
  TapFleet fleet{2};

  const std::int64_t sent_ns = posix::monotonic_now_ns();
  fleet.send(0, test_address(255), std::string(64, 'x'));
  REQUIRE(fleet.receive(1) == std::string(64, 'x'));
  const std::int64_t received_ns = posix::monotonic_now_ns();

  // DIFS 50 us and 202 us on the air (128 B of PSDU at 6 Mb/s).
  CHECK(received_ns - sent_ns >= 252'000);
}

TEST_CASE("each node's report has the most frames that waited and the releases to its interface") {
  TapFleet fleet{2};
  constexpr std::uint32_t kBurst = 20;

  fleet.stall(100'000'000, [&] {
    for (std::uint32_t i = 0; i < kBurst; ++i) {
      fleet.send(0, test_address(255), "frame " + std::to_string(i));
    }
  });
  for (std::uint32_t i = 0; i < kBurst; ++i) {
    REQUIRE(fleet.receive(1) == "frame " + std::to_string(i));
  }
  fleet.stop();

  // All were sent before the emulator could look; each takes 0.3 ms on the air.
  const proto::NodeServiceReport sender = fleet.air().service_report(0);
  const proto::NodeServiceReport receiver = fleet.air().service_report(1);
  CHECK(sender.queue_high_water() == kBurst);
  CHECK(sender.releases() == 0);
  CHECK(receiver.queue_high_water() == 0);
  CHECK(receiver.releases() == kBurst);
  CHECK(receiver.late_releases() <= receiver.releases());
  CHECK(receiver.release_lateness_max_ns() == fleet.air().report().release_lateness().max_ns());
}

using RawFrame = std::array<std::uint8_t, 60>;

/// Sends it past node 0's own IP stack.
void send_raw(TapFleet& fleet, const RawFrame& frame) {
  fleet.nodes()[0].space.run([&] {
    const posix::UniqueFd raw{
        posix::check("socket", ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0))};
    sockaddr_ll to{};
    to.sll_family = AF_PACKET;
    to.sll_ifindex = static_cast<int>(::if_nametoindex("wlan0"));
    posix::check("sendto", ::sendto(raw.get(), frame.data(), frame.size(), 0,
                                    reinterpret_cast<const sockaddr*>(&to), sizeof to));
  });
}

TEST_CASE("802.3 lengths and VLAN tags are counted, dropped, and delivered to nobody") {
  TapFleet fleet{2};
  // A length of 46 and a customer tag where Ethernet II has its type.
  send_raw(fleet, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 1, 0, 46});
  send_raw(fleet, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 1, 0x81, 0, 0, 5, 8, 0});
  fleet.send(0, test_address(255), "after them");

  REQUIRE(fleet.receive(1) == "after them");
  fleet.stop();

  CHECK(fleet.air().tally(0).dropped_malformed == 2);
  CHECK(fleet.air().tally(0).offered == 3);
  CHECK(fleet.air().tally(1).received == 1);
}

TEST_CASE("a frame with another node's source address is still its sender's") {
  TapFleet fleet{3};
  // Broadcast, "from" node 1.
  send_raw(fleet, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 2, 0x88, 0xb5});
  fleet.send(0, test_address(255), "after it");

  REQUIRE(fleet.receive(1) == "after it");
  REQUIRE(fleet.receive(2) == "after it");
  fleet.stop();

  CHECK(fleet.air().tally(0).offered == 2);
  CHECK(fleet.air().tally(1).offered == 0);
  CHECK(fleet.air().tally(1).received == 2);
  CHECK(fleet.air().tally(2).received == 2);
}

TEST_CASE("a receiver whose interface is down loses its copies, and the others do not") {
  TapFleet fleet{3};
  fleet.nodes()[1].space.run([&] {
    ifreq request{};
    std::strncpy(request.ifr_name, "wlan0", IFNAMSIZ - 1);
    posix::check("SIOCSIFFLAGS", ::ioctl(fleet.nodes()[1].socket.get(), SIOCSIFFLAGS, &request));
  });

  fleet.send(0, test_address(255), "who is there");
  REQUIRE(fleet.receive(2) == "who is there");
  fleet.stop();

  CHECK(fleet.air().tally(1).lost_interface == 1);
  CHECK(fleet.air().tally(1).received == 0);
  CHECK(fleet.air().tally(2).received == 1);
}

}  // namespace
}  // namespace cuscus::netsim
