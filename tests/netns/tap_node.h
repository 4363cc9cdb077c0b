#pragma once

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

#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/network_namespace.h"
#include "netsim/app/live_air.h"

namespace cuscus::netsim {

inline constexpr std::uint16_t kTestPort = 5000;

[[nodiscard]] inline std::array<std::uint8_t, 6> test_mac(std::uint32_t node) {
  return {0x02, 0, 0, 0, 0, static_cast<std::uint8_t>(node + 1)};
}

/// 10.0.0.`last_octet`; nodes have node + 1, and 255 is everybody.
[[nodiscard]] inline sockaddr_in test_address(std::uint32_t last_octet) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kTestPort);
  address.sin_addr.s_addr = htonl(0x0A000000U + last_octet);
  return address;
}

/// A namespace with a TAP 'wlan0', 10.0.0.(node + 1)/24, and a UDP socket.
struct TapNode {
  posix::NetworkNamespace space = posix::NetworkNamespace::create();
  posix::UniqueFd tap;
  posix::UniqueFd socket;
};

/// Runs on a thread inside the namespace.
inline void set_up(TapNode& node, std::uint32_t number) {
  using posix::check;
  std::ofstream{"/proc/sys/net/ipv6/conf/default/disable_ipv6"} << "1";
  node.tap = posix::UniqueFd{
      check("open /dev/net/tun", ::open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK))};
  ifreq request{};
  std::strncpy(request.ifr_name, "wlan0", IFNAMSIZ - 1);
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  check("TUNSETIFF", ::ioctl(node.tap.get(), TUNSETIFF, &request));
  node.socket = posix::UniqueFd{check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  const int fd = node.socket.get();
  request.ifr_hwaddr.sa_family = ARPHRD_ETHER;
  const auto mac = test_mac(number);
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
  // What one of these tests sends fits, however long the test's thread waits before it reads.
  const int bytes = 64 << 20;
  check("SO_RCVBUFFORCE", ::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(kTestPort);
  check("bind", ::bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof any));
}

/// Nodes 5 m apart, and the live air between them in a thread of its own.
class TapFleet final : public LiveOwner {
 public:
  /// Makes the ring of send stamps, if there is to be one; called before the air begins.
  using MakeStamps = std::function<std::unique_ptr<StampRing>(std::vector<TapNode>&)>;

  explicit TapFleet(std::uint32_t count, const MakeStamps& make_stamps = {})
      : nodes_(count), positions_{on_a_line(count)} {
    LiveSetup setup;
    setup.air.nodes.assign(count, AirNode{});
    for (std::uint32_t i = 0; i < count; ++i) {
      nodes_[i].space.run([&] { set_up(nodes_[i], i); });
      setup.addresses.push_back(mac_address(test_mac(i)));
    }
    if (make_stamps) {
      setup.stamps = make_stamps(nodes_);
    }
    for (TapNode& node : nodes_) {
      setup.taps.push_back(std::move(node.tap));
    }
    memory_.resize(shm::RadioMemoryWriter::byte_size(count) / sizeof(Line) + 1);
    setup.radio_memory =
        std::as_writable_bytes(std::span{memory_}).first(shm::RadioMemoryWriter::byte_size(count));
    air_.emplace(std::move(setup), positions_);
    thread_ = std::thread{[this] { air_->run(posix::monotonic_now_ns() + 1'000'000, *this); }};
    beating_.wait(false);
  }
  TapFleet(const TapFleet&) = delete;
  TapFleet& operator=(const TapFleet&) = delete;
  TapFleet(TapFleet&&) = delete;
  TapFleet& operator=(TapFleet&&) = delete;
  ~TapFleet() override { stop(); }

  void stop() {
    if (thread_.joinable()) {
      const std::uint64_t one = 1;
      static_cast<void>(::write(wake_.get(), &one, sizeof one));
      thread_.join();
    }
  }

  void send(std::uint32_t from, const sockaddr_in& to, const std::string& text) {
    posix::check("sendto", ::sendto(nodes_[from].socket.get(), text.data(), text.size(), 0,
                                    reinterpret_cast<const sockaddr*>(&to), sizeof to));
  }

  /// The next datagram at `node`; empty after 5 s without one.
  std::string receive(std::uint32_t node) {
    pollfd ready{.fd = nodes_[node].socket.get(), .events = POLLIN, .revents = 0};
    if (posix::check("poll", ::poll(&ready, 1, 5'000)) == 0) {
      return {};
    }
    std::array<char, 2048> buffer{};
    const auto bytes = posix::check("recv", ::recv(ready.fd, buffer.data(), buffer.size(), 0));
    return {buffer.data(), static_cast<std::size_t>(bytes)};
  }

  /// Keeps the emulator's thread from its work for `duration_ns`; `meanwhile` runs at the
  /// beginning.
  void stall(std::int64_t duration_ns, const std::function<void()>& meanwhile) {
    stall_ns_ = duration_ns;
    stall_ns_.wait(duration_ns);
    meanwhile();
    stalled_.wait(true);
  }

  [[nodiscard]] std::vector<TapNode>& nodes() { return nodes_; }
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
    beating_ = true;
    beating_.notify_all();
    if (stall_ns_ > 0) {
      const std::int64_t end_ns = posix::monotonic_now_ns() + stall_ns_;
      stalled_ = true;
      stall_ns_ = 0;
      stall_ns_.notify_all();
      posix::sleep_until_monotonic(end_ns);
      stalled_ = false;
      stalled_.notify_all();
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

  std::vector<TapNode> nodes_;
  FixedPositions positions_;
  std::vector<Line> memory_;
  posix::UniqueFd wake_{posix::check("eventfd", ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))};
  std::optional<LiveAir> air_;
  std::atomic<bool> beating_{false};
  std::atomic<std::int64_t> stall_ns_{0};
  std::atomic<bool> stalled_{false};
  std::thread thread_;
};

}  // namespace cuscus::netsim
