#include "orchestrator/netlink/monitor_device.h"

#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "common/posix/check.h"
#include "common/posix/network_namespace.h"
#include "netsim/app/monitor_devices.h"
#include "orchestrator/netlink/route_socket.h"
#include "tests/support/root_only.h"

namespace cuscus::netsim {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// mon0 in a namespace, which is down, and a socket that sees what comes out of it.
struct Listener {
  Listener() {
    space.run([this] {
      const auto made = netlink::MonitorDevice::create("mon0");
      device = posix::UniqueFd{posix::check("dup", ::dup(made.fd()))};
      socket = posix::UniqueFd{
          posix::check("socket", ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(ETH_P_ALL)))};
      sockaddr_ll address{};
      address.sll_family = AF_PACKET;
      address.sll_protocol = htons(ETH_P_ALL);
      address.sll_ifindex = static_cast<int>(::if_nametoindex("mon0"));
      posix::check("bind", ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address),
                                  sizeof address));
    });
  }
  void set_up() {
    space.run([] { netlink::RouteSocket{}.change_link("mon0", {.up = true}); });
    // A socket on an interface that was down tells so first.
    int error = 0;
    socklen_t length = sizeof error;
    posix::check("SO_ERROR", ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &length));
  }
  /// The next packet; empty after 5 s without one.
  std::vector<std::uint8_t> receive() {
    pollfd ready{.fd = socket.get(), .events = POLLIN, .revents = 0};
    std::vector<std::uint8_t> packet(2'048);
    socklen_t length = sizeof from;
    if (::poll(&ready, 1, 5'000) != 1) {
      return {};
    }
    const auto bytes = ::recvfrom(socket.get(), packet.data(), packet.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &length);
    packet.resize(static_cast<std::size_t>(std::max<::ssize_t>(bytes, 0)));
    return packet;
  }

  posix::NetworkNamespace space = posix::NetworkNamespace::create();
  posix::UniqueFd device;
  posix::UniqueFd socket;
  sockaddr_ll from{};
};

PpduEncoder encoder() {
  AirParameters air;
  air.nodes.assign(2, AirNode{});
  return {air, {0x020000000001, 0x020000000002}};
}

std::vector<posix::UniqueFd> only(posix::UniqueFd device) {
  std::vector<posix::UniqueFd> devices;
  devices.push_back(std::move(device));
  devices.emplace_back();
  return devices;
}

/// Node 0 has received an ACK of node 1.
PpduRecord ack() {
  PpduRecord record{.node = 0};
  record.ppdu = {.frame = {.kind = MacFrame::Kind::kAck, .sender = 1, .receiver = 0},
                 .mode = &ieee80211g().mode(24'000)};
  record.reception = {.power = {-61.0}};
  return record;
}

/// Until the interface has to be asked again.
void await_question(const MonitorDevices& monitors) {
  while (!monitors.wants(0)) {
    std::this_thread::yield();
  }
}

TEST_CASE("a packet comes out of mon0 with the link type and protocol of radiotap") {
  CUSCUS_ROOT_ONLY();
  Listener listener;
  listener.set_up();
  MonitorDevices monitors{only(std::move(listener.device)), encoder()};
  CHECK(monitors.wants(0));
  CHECK_FALSE(monitors.wants(1));  // it has none

  monitors.add(ack(), {});
  const auto packet = listener.receive();

  REQUIRE(packet.size() == 24 + 14);
  CHECK(packet[2] == 24);  // length of the radiotap header
  CHECK(static_cast<std::int8_t>(packet[22]) == -61);
  CHECK(packet[24] == 0xd4);  // ACK
  CHECK(listener.from.sll_hatype == ARPHRD_IEEE80211_RADIOTAP);
  CHECK(listener.from.sll_protocol == htons(0x0019));
  monitors.finish();
  CHECK(monitors.packets() == 1);
  CHECK(monitors.packets_left_out() == 0);
}

TEST_CASE("an interface that is down is asked every 100 ms until it is up") {
  CUSCUS_ROOT_ONLY();
  Listener listener;
  MonitorDevices monitors{only(std::move(listener.device)), encoder()};

  const auto asked = steady_clock::now();
  monitors.add(ack(), {});
  CHECK_FALSE(monitors.wants(0));
  await_question(monitors);
  CHECK(steady_clock::now() - asked >= milliseconds{100});
  listener.set_up();
  monitors.add(ack(), {});

  CHECK(listener.receive().size() == 38);
  monitors.finish();
  CHECK(monitors.packets() == 1);
  CHECK(monitors.wants(0));
}

}  // namespace
}  // namespace cuscus::netsim
