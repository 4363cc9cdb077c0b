#include "orchestrator/node/canary.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string>

#include "common/posix/check.h"
#include "common/posix/kernel_settings.h"
#include "common/posix/monotonic_clock.h"

namespace cuscus::node {
namespace {

constexpr std::uint16_t kPort = 9;
constexpr std::size_t kProbeBytes = 100;

/// In 198.18.0.0/15, which is for benchmarks (RFC 2544, appendix C.2.2). Nobody else can see it.
netlink::Ipv4Address address_of_end(std::uint8_t end) {
  return {198, 18, 0, static_cast<std::uint8_t>(end + 1)};
}

/// Locally administered; no node has it (they are numbered from 1 in the last two octets).
netlink::MacAddress mac_of_end(std::uint8_t end) { return {0x02, 0x63, 0x61, 0x6e, 0, end}; }

sockaddr_in socket_address(const netlink::Ipv4Address& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(kPort);
  std::memcpy(&result.sin_addr, address.data(), address.size());
  return result;
}

posix::UniqueFd open_socket(std::uint8_t end) {
  posix::UniqueFd socket{
      posix::check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0))};
  const sockaddr_in own = socket_address(address_of_end(end));
  posix::check("bind the canary's socket",
               ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own));
  const sockaddr_in other = socket_address(address_of_end(1 - end));
  posix::check("connect the canary's socket",
               ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&other), sizeof other));
  return socket;
}

/// Whether there is something to read at `fd` by `deadline_ns`.
bool wait_readable(int fd, std::int64_t deadline_ns) {
  for (;;) {
    const std::int64_t left_ns = std::max<std::int64_t>(0, deadline_ns - posix::monotonic_now_ns());
    const timespec timeout{.tv_sec = left_ns / 1'000'000'000, .tv_nsec = left_ns % 1'000'000'000};
    pollfd readable{.fd = fd, .events = POLLIN, .revents = 0};
    const int ready = ::ppoll(&readable, 1, &timeout, nullptr);
    if (ready >= 0 || errno != EINTR) {
      return posix::check("wait for the canary", ready) > 0;
    }
  }
}

}  // namespace

Canary::Canary(const Fabric& fabric, std::uint32_t first_index, Attachment attachment,
               Surroundings surroundings) {
  const std::array<netlink::Neighbour, 2> neighbours{
      {{.address = address_of_end(0), .mac = mac_of_end(0)},
       {.address = address_of_end(1), .mac = mac_of_end(1)}}};
  surroundings.neighbours = neighbours;
  auto fabric_routes = netlink::RouteSocket::in(fabric.network_namespace());
  for (std::uint8_t end = 0; end < 2; ++end) {
    const NodeNetwork network{.index = first_index + end,
                              .name = "canary" + std::to_string(end),
                              .mac = mac_of_end(end),
                              .address = {.address = address_of_end(end), .length = 30},
                              .attachment = attachment};
    ends_.push_back(make_end(fabric, fabric_routes, network, surroundings));
    ends_.back().socket = ends_.back().space.run([end] { return open_socket(end); });
  }
}

Canary::End Canary::make_end(const Fabric& fabric, netlink::RouteSocket& fabric_routes,
                             const NodeNetwork& network, const Surroundings& surroundings) {
  auto space = posix::NetworkNamespace::create();
  space.run([] {
    for (const std::string scope : {"all", "default"}) {
      posix::write_sysctl("net/ipv6/conf/" + scope + "/disable_ipv6", "1");
    }
  });
  auto tap = build_links(network, space, fabric, fabric_routes, surroundings);
  return {.space = std::move(space), .tap = std::move(tap), .socket = {}};
}

void Canary::start() {
  singer_ = std::jthread{[this](const std::stop_token& stopped) { sing(stopped); }};
}

void Canary::stop() {
  if (singer_.joinable()) {
    singer_.request_stop();
    singer_.join();
  }
}

void Canary::sing(const std::stop_token& stopped) {
  constexpr std::int64_t kPeriod_ns = std::chrono::nanoseconds{kPeriod}.count();
  for (std::int64_t due_ns = posix::monotonic_now_ns(); !stopped.stop_requested();) {
    probe();
    // A probe that took long has no successors to make up for.
    due_ns = std::max(due_ns + kPeriod_ns, posix::monotonic_now_ns());
    posix::sleep_until_monotonic(due_ns);
  }
}

void Canary::probe() {
  const int out = ends_[0].socket.get();
  const int in = ends_[1].socket.get();
  std::array<std::byte, kProbeBytes> datagram{};
  const std::uint64_t number = ++tally_.sent;
  std::memcpy(datagram.data(), &number, sizeof number);
  const std::int64_t sent_ns = posix::monotonic_now_ns();
  if (::send(out, datagram.data(), datagram.size(), 0) < 0) {
    ++tally_.lost;
    return;
  }
  const std::int64_t deadline_ns = sent_ns + std::chrono::nanoseconds{kPatience}.count();
  while (wait_readable(in, deadline_ns)) {
    const std::int64_t seen_ns = posix::monotonic_now_ns();
    std::uint64_t heard = 0;
    if (::recv(in, datagram.data(), datagram.size(), 0) < 0) {
      continue;
    }
    std::memcpy(&heard, datagram.data(), sizeof heard);
    if (heard == number) {
      tally_.late.add(seen_ns - sent_ns - kDelay.count());
      return;
    }
  }
  ++tally_.lost;
}

}  // namespace cuscus::node
