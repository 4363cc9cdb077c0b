#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/network_namespace.h"
#include "netsim/app/live_air.h"

namespace cuscus::netsim {
namespace {

using posix::check;
using posix::NetworkNamespace;
using posix::UniqueFd;

constexpr std::uint16_t kPort = 5000;

std::array<std::uint8_t, 6> address_of(std::uint32_t node) {
  return {0x02, 0, 0, 0, 0, static_cast<std::uint8_t>(node + 1)};
}

sockaddr_in inet_address(std::uint32_t last_octet) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kPort);
  address.sin_addr.s_addr = htonl(0x0A000000U + last_octet);
  return address;
}

/// A namespace with a TAP 'wlan0', 10.0.0.(node + 1)/24, and a UDP socket.
struct LiveNode {
  NetworkNamespace space = NetworkNamespace::create();
  UniqueFd tap;
  UniqueFd socket;
};

/// Runs on a thread inside the namespace.
void set_up(LiveNode& node, std::uint32_t number) {
  std::ofstream{"/proc/sys/net/ipv6/conf/default/disable_ipv6"} << "1";
  node.tap =
      UniqueFd{check("open /dev/net/tun", ::open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK))};
  ifreq request{};
  std::strncpy(request.ifr_name, "wlan0", IFNAMSIZ);
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  check("TUNSETIFF", ::ioctl(node.tap.get(), TUNSETIFF, &request));
  node.socket = UniqueFd{check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  const int fd = node.socket.get();
  request.ifr_hwaddr.sa_family = ARPHRD_ETHER;
  const auto mac = address_of(number);
  std::memcpy(request.ifr_hwaddr.sa_data, mac.data(), mac.size());
  check("SIOCSIFHWADDR", ::ioctl(fd, SIOCSIFHWADDR, &request));
  const auto set = [&](unsigned long what, std::uint32_t ip) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(ip);
    std::memcpy(&request.ifr_addr, &address, sizeof address);
    check("set an address", ::ioctl(fd, what, &request));
  };
  set(SIOCSIFADDR, 0x0A000001U + number);
  set(SIOCSIFNETMASK, 0xFFFFFF00U);
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  check("SIOCSIFFLAGS", ::ioctl(fd, SIOCSIFFLAGS, &request));
  const int on = 1;
  check("SO_BROADCAST", ::setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &on, sizeof on));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(kPort);
  check("bind", ::bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof any));
}

/// Three nodes, 5 m apart, and the air between them in a thread of its own.
class Fleet final : public LiveOwner {
 public:
  explicit Fleet(std::uint32_t count) : nodes_(count), positions_{on_a_line(count)} {
    LiveSetup setup;
    setup.air.nodes.assign(count, AirNode{});
    for (std::uint32_t i = 0; i < count; ++i) {
      nodes_[i].space.run([&] { set_up(nodes_[i], i); });
      setup.taps.push_back(std::move(nodes_[i].tap));
      setup.addresses.push_back(mac_address(address_of(i)));
    }
    memory_.resize(shm::RadioMemoryWriter::byte_size(count) / sizeof(Line) + 1);
    setup.radio_memory =
        std::as_writable_bytes(std::span{memory_}).first(shm::RadioMemoryWriter::byte_size(count));
    air_.emplace(std::move(setup), positions_);
    thread_ = std::thread{[this] { air_->run(posix::monotonic_now_ns() + 1'000'000, *this); }};
    started_.lock();  // until the first heartbeat
    started_.lock();
  }
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;
  ~Fleet() override { stop(); }

  void stop() {
    if (thread_.joinable()) {
      const std::uint64_t one = 1;
      check("write eventfd", ::write(wake_.get(), &one, sizeof one));
      thread_.join();
    }
  }

  void send(std::uint32_t from, const sockaddr_in& to, const std::string& text) {
    check("sendto", ::sendto(nodes_[from].socket.get(), text.data(), text.size(), 0,
                             reinterpret_cast<const sockaddr*>(&to), sizeof to));
  }

  /// The next datagram at `node`; empty after 5 s without one.
  std::string receive(std::uint32_t node) {
    pollfd ready{.fd = nodes_[node].socket.get(), .events = POLLIN, .revents = 0};
    if (check("poll", ::poll(&ready, 1, 5'000)) == 0) {
      return {};
    }
    std::array<char, 2048> buffer{};
    const auto bytes = check("recv", ::recv(ready.fd, buffer.data(), buffer.size(), 0));
    return {buffer.data(), static_cast<std::size_t>(bytes)};
  }

  [[nodiscard]] const LiveAir& air() const { return *air_; }
  [[nodiscard]] shm::RadioMemoryReader memory() const {
    return shm::RadioMemoryReader{
        std::as_bytes(std::span{memory_})
            .first(shm::RadioMemoryWriter::byte_size(static_cast<std::uint32_t>(nodes_.size())))};
  }

  [[nodiscard]] int fd() const override { return wake_.get(); }
  [[nodiscard]] bool should_stop() override {
    std::uint64_t count = 0;
    return ::read(wake_.get(), &count, sizeof count) > 0;
  }
  void beat(SimTime /*now*/) override {
    if (!beating_) {
      beating_ = true;
      started_.unlock();
    }
  }

 private:
  struct alignas(64) Line {
    std::array<std::byte, 64> bytes;
  };

  static std::vector<Eigen::Vector3d> on_a_line(std::uint32_t count) {
    std::vector<Eigen::Vector3d> positions;
    for (std::uint32_t i = 0; i < count; ++i) {
      positions.emplace_back(5.0 * i, 0.0, 10.0);
    }
    return positions;
  }

  std::vector<LiveNode> nodes_;
  FixedPositions positions_;
  std::vector<Line> memory_;
  UniqueFd wake_{check("eventfd", ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))};
  std::optional<LiveAir> air_;
  class Gate {
   public:
    void lock() {
      while (flag_.test_and_set(std::memory_order_acquire)) {
        flag_.wait(true, std::memory_order_relaxed);
      }
    }
    void unlock() {
      flag_.clear(std::memory_order_release);
      flag_.notify_all();
    }

   private:
    std::atomic_flag flag_ = ATOMIC_FLAG_INIT;
  };
  Gate started_;
  bool beating_{false};
  std::thread thread_;
};

TEST_CASE("broadcast datagrams reach every other node once, with their contents") {
  Fleet fleet{3};
  constexpr int kDatagrams = 40;

  for (int i = 0; i < kDatagrams; ++i) {
    const auto from = static_cast<std::uint32_t>(i % 3);
    const std::string text = "datagram " + std::to_string(i);
    fleet.send(from, inet_address(255), text);
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
  Fleet fleet{3};

  for (int i = 0; i < 10; ++i) {
    fleet.send(0, inet_address(3), "question " + std::to_string(i));
    REQUIRE(fleet.receive(2) == "question " + std::to_string(i));
    fleet.send(2, inet_address(1), "answer " + std::to_string(i));
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
  Fleet fleet{2};

  const std::int64_t sent_ns = posix::monotonic_now_ns();
  fleet.send(0, inet_address(255), std::string(64, 'x'));
  REQUIRE(fleet.receive(1) == std::string(64, 'x'));
  const std::int64_t received_ns = posix::monotonic_now_ns();

  // DIFS 50 us and 202 us on the air (128 B of PSDU at 6 Mb/s).
  CHECK(received_ns - sent_ns >= 252'000);
}

}  // namespace
}  // namespace cuscus::netsim
