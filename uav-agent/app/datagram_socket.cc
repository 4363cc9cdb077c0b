#include "uav-agent/app/datagram_socket.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cerrno>
#include <stdexcept>

#include "common/posix/check.h"

namespace cuscus::agent {

sockaddr_in endpoint(const std::string& address, std::uint32_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1) {
    throw std::invalid_argument{"'" + address + "' is not an IPv4 address"};
  }
  return result;
}

DatagramSocket::DatagramSocket(std::uint32_t port)
    : fd_{posix::check("open a UDP socket",
                       ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0))} {
  const int on = 1;
  posix::check("allow broadcasts",
               ::setsockopt(fd_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on));
  const sockaddr_in local = endpoint("0.0.0.0", port);
  posix::check("bind a UDP socket",
               ::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&local), sizeof local));
}

bool DatagramSocket::try_send(std::span<const char> payload, const sockaddr_in& to) noexcept {
  return ::sendto(fd_.get(), payload.data(), payload.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&to),
                  sizeof to) == static_cast<ssize_t>(payload.size());
}

std::optional<std::span<const std::byte>> DatagramSocket::try_receive(
    std::span<std::byte> buffer) noexcept {
  for (;;) {
    const ssize_t received = ::recv(fd_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (received >= 0) {
      return std::span<const std::byte>{buffer.first(static_cast<std::size_t>(received))};
    }
    // An ICMP error of an earlier send or an interface that went down: what waits behind it counts.
    if (errno != EINTR && errno != ECONNREFUSED && errno != ENETDOWN && errno != EHOSTUNREACH &&
        errno != ENETUNREACH) {
      return std::nullopt;
    }
  }
}

}  // namespace cuscus::agent
