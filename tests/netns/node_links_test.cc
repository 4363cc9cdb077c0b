#include <arpa/inet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/processors.h"
#include "orchestrator/netlink/link_watch.h"
#include "orchestrator/netlink/offloads.h"
#include "orchestrator/node/fleet.h"
#include "tests/support/node_programs.h"
#include "tests/support/root_only.h"
#include "tests/support/tap_forwarder.h"
#include "tests/support/test_fleet.h"

namespace cuscus::node {
namespace {

using test::run_in;
using test::TapForwarder;
using test::test_fleet;

Attachment any_attachment() { return GENERATE(Attachment::kBridge, Attachment::kDirect); }

std::set<std::string> own_interfaces() {
  std::set<std::string> names;
  struct if_nameindex* const table = ::if_nameindex();
  for (const auto* entry = table; entry != nullptr && entry->if_index != 0; ++entry) {
    names.emplace(entry->if_name);
  }
  ::if_freenameindex(table);
  return names;
}

/// Sends `text` by UDP to 10.0.0.2, from inside a node.
void send_datagram(const Node& node, const std::string& text) {
  node.network_namespace().run([&] {
    const posix::UniqueFd socket{
        posix::check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(9);
    ::inet_pton(AF_INET, "10.0.0.2", &to.sin_addr);
    posix::check("sendto", ::sendto(socket.get(), text.data(), text.size(), 0,
                                    reinterpret_cast<const sockaddr*>(&to), sizeof to));
  });
}

/// The next frame on a node's TAP, empty when there is none.
std::string read_frame(const Node& node) {
  std::string frame(2048, '\0');
  const ssize_t length = ::read(node.tap_fd(), frame.data(), frame.size());
  frame.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  return frame;
}

TEST_CASE("nodes reach one another by name through their TAPs, without rights") {
  CUSCUS_ROOT_ONLY();
  const auto attachment = any_attachment();
  const bool static_neighbours = GENERATE(true, false);
  Fleet fleet{test_fleet(3, attachment), {.static_neighbours = static_neighbours}};
  const TapForwarder air{fleet.nodes()};

  const auto run = run_in(fleet.nodes()[0], {"ping", "-c", "2", "-i", "0.05", "-W", "5", "uav2"});

  INFO(run.output);
  CHECK(run.exited.error().empty());
  CHECK(run.exited.exit_code() == 0);
  CHECK(run.output.find("uav2 (10.0.0.3)") != std::string::npos);
}

TEST_CASE("without anybody who forwards, a node is alone") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test_fleet(2, any_attachment()), {}};

  const auto run = run_in(fleet.nodes()[0], {"ping", "-c", "1", "-W", "0.2", "uav1"});

  CHECK(run.exited.exit_code() == 1);
}

TEST_CASE("an interface has the address and size that were asked for, and whole frames") {
  CUSCUS_ROOT_ONLY();
  auto networks = test_fleet(1, any_attachment());
  networks[0].mac = {2, 0x17, 0x2a, 0, 1, 0xfe};
  networks[0].mtu_bytes = 1400;
  networks[0].queue_frames = 1234;
  Fleet fleet{networks, {}};
  Node& node = fleet.nodes()[0];

  const auto run = run_in(node, {"sh", "-c",
                                 "cd /sys/class/net; echo *; cd wlan0; cat address mtu "
                                 "tx_queue_len; hostname"});

  CHECK(run.output == "lo mon0 wlan0\n02:17:2a:00:01:fe\n1400\n1234\nuav0\n");
  CHECK_FALSE(node.network_namespace().run([] { return netlink::has_offloads(kInterface); }));
}

/// Whether `watch` hears within 5 s that `link` has or has lost its carrier, as `wanted`.
bool hears(netlink::LinkWatch& watch, const std::string& link, bool wanted) {
  pollfd readable{.fd = watch.fd(), .events = POLLIN, .revents = 0};
  while (::poll(&readable, 1, 5'000) > 0) {
    for (const auto& change : watch.take()) {
      if (change.name == link && change.has_carrier == wanted) {
        return true;
      }
    }
  }
  return false;
}

TEST_CASE("the kernel delivers to each node on one of the processors that were asked for") {
  CUSCUS_ROOT_ONLY();
  const auto attachment = any_attachment();
  const std::vector<int> processors = posix::allowed_processors();
  Fleet fleet{test_fleet(3, attachment), {.receive_processors = processors}};
  const TapForwarder air{fleet.nodes()};

  const auto ping = run_in(fleet.nodes()[0], {"ping", "-c", "2", "-i", "0.05", "-W", "5", "uav2"});

  CHECK(ping.exited.exit_code() == 0);
  if (attachment == Attachment::kDirect) {
    for (std::size_t node = 0; node < fleet.nodes().size(); ++node) {
      const std::vector expected{processors[node % processors.size()]};
      const auto mask =
          run_in(fleet.nodes()[node], {"cat", "/sys/class/net/wlan0/queues/rx-0/rps_cpus"});
      CHECK(mask.output == posix::processor_mask(expected) + "\n");
    }
  }
  // Nodes still cannot change it.
  CHECK(run_in(fleet.nodes()[0], {"sh", "-c", "echo 0 > /sys/class/net/wlan0/queues/rx-0/rps_cpus"})
            .exited.exit_code() != 0);
}

TEST_CASE("the fabric hears of a bridged node's interface that goes down, up, and away") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test_fleet(1, Attachment::kBridge), {}};
  auto watch = netlink::LinkWatch::in(fleet.fabric().network_namespace());
  auto routes = netlink::RouteSocket::in(fleet.nodes()[0].network_namespace());

  routes.change_link(kInterface, {.up = false});
  CHECK(hears(watch, "veth0", false));
  routes.change_link(kInterface, {.up = true});
  CHECK(hears(watch, "veth0", true));
  routes.delete_link(kInterface);
  CHECK(hears(watch, "veth0", false));
}

TEST_CASE("the first frame on the air is the first that a program sends, checksums filled in") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test_fleet(2, any_attachment()), {}};
  Node& node = fleet.nodes()[0];
  // Longer than the kernel takes to send router solicitations and group reports, where it does.
  constexpr int kQuietMs = 1'200;
  pollfd tap{.fd = node.tap_fd(), .events = POLLIN, .revents = 0};
  CHECK(::poll(&tap, 1, kQuietMs) == 0);

  send_datagram(node, "hello");

  const std::string frame = read_frame(node);
  // Ethernet 14 B, IPv4 20 B, UDP 8 B, then the text.
  REQUIRE(frame.size() == 14 + 20 + 8 + 5);
  CHECK(frame.substr(0, 6) == std::string("\x02\x00\x00\x00\x00\x02", 6));
  CHECK(frame.substr(6, 6) == std::string("\x02\x00\x00\x00\x00\x01", 6));
  CHECK(frame.substr(42) == "hello");
  // RFC 768: the sum of pseudo-header and datagram, checksum included, is all ones.
  std::uint32_t sum = 17 + 8 + 5;  // protocol and UDP length
  const std::string summed = frame.substr(26) + std::string(1, '\0');
  for (std::size_t i = 0; i + 1 < summed.size(); i += 2) {
    sum += static_cast<std::uint32_t>(static_cast<unsigned char>(summed[i])) << 8U |
           static_cast<unsigned char>(summed[i + 1]);
  }
  while (sum > 0xffff) {
    sum = (sum & 0xffffU) + (sum >> 16U);
  }
  CHECK(sum == 0xffff);
  CHECK(read_frame(node).empty());
}

TEST_CASE("a node has IPv6 only where it is asked for") {
  CUSCUS_ROOT_ONLY();
  auto networks = test_fleet(2, any_attachment());
  networks[1].ipv6 = true;
  Fleet fleet{networks, {}};
  if (::access("/proc/net/if_inet6", F_OK) != 0) {
    WARN("SKIPPED: this kernel has no IPv6");
    return;
  }

  const std::vector<std::string> wlan_addresses{"grep", "wlan0", "/proc/net/if_inet6"};
  const auto without = run_in(fleet.nodes()[0], wlan_addresses);
  const auto with = run_in(fleet.nodes()[1], wlan_addresses);

  CHECK(without.output.empty());
  CHECK(with.output.starts_with("fe80"));
}

TEST_CASE("broadcast and multicast leave without a default route") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test_fleet(1, any_attachment()), {}};

  const auto run = run_in(fleet.nodes()[0], {"bash", "-c", "cat /proc/net/route | cut -f1,2,8"});

  // Destination and mask, little-endian: the node's own network, 255.255.255.255/32, 224.0.0.0/4.
  CHECK(run.output.find("wlan0\t0000000A\t0000FFFF") != std::string::npos);
  CHECK(run.output.find("wlan0\tFFFFFFFF\tFFFFFFFF") != std::string::npos);
  CHECK(run.output.find("wlan0\t000000E0\t000000F0") != std::string::npos);
  CHECK(run.output.find("wlan0\t00000000") == std::string::npos);
}

TEST_CASE("what a TAP drops because nobody reads is counted") {
  CUSCUS_ROOT_ONLY();
  auto networks = test_fleet(2, any_attachment());
  networks[0].queue_frames = 50;
  Fleet fleet{networks, {}};
  Node& node = fleet.nodes()[0];
  constexpr std::uint64_t kSent = 80;

  for (std::uint64_t i = 0; i < kSent; ++i) {
    send_datagram(node, "x");
  }

  std::uint64_t kept = 0;
  while (!read_frame(node).empty()) {
    ++kept;
  }
  CHECK(kept < kSent);
  CHECK(node.tap_counters(fleet.fabric()).send_drops == kSent - kept);
}

TEST_CASE("the host's interfaces are left alone") {
  CUSCUS_ROOT_ONLY();
  const auto before = own_interfaces();

  const Fleet fleet{test_fleet(2, any_attachment()), {}};

  CHECK(own_interfaces() == before);
}

TEST_CASE("a fleet that cannot be built says why") {
  CUSCUS_ROOT_ONLY();
  auto networks = test_fleet(2, any_attachment());

  SECTION("an address that is none") {
    networks[1].address.length = 40;
    CHECK_THROWS_WITH((Fleet{networks, {}}), Catch::StartsWith("uav1: add address 10.0.0.2"));
  }
  SECTION("an init that is not there") {
    CHECK_THROWS_WITH((Fleet{networks, {.init_path = "/no/such/init"}}),
                      "execute '/no/such/init': No such file or directory");
  }
  SECTION("an init that never answers, of which the owner tires") {
    networks[0].name = "1000000";  // sleeps as many seconds
    const FleetOptions options{
        .init_path = "/bin/sleep",
        .ready_limit = std::chrono::hours{1},
        .on_wait = [] { throw std::runtime_error{"enough"}; },
    };
    CHECK_THROWS_WITH((Fleet{{networks.data(), 1}, options}), "enough");
  }
  SECTION("an init that is not ready in time") {
    networks[0].name = "1000000";
    const FleetOptions options{.init_path = "/bin/sleep",
                               .ready_limit = std::chrono::milliseconds{1}};
    CHECK_THROWS_WITH((Fleet{{networks.data(), 1}, options}),
                      "1000000: its init was not ready in 1 ms");
  }
  SECTION("a node too many") {
    networks[1].index = 1000;
    CHECK_THROWS_WITH((Fleet{networks, {}}), "node 1000: there are at most 1000 nodes");
  }
}

}  // namespace
}  // namespace cuscus::node
