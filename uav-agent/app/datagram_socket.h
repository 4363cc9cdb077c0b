#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/posix/unique_fd.h"

namespace cuscus::agent {

/// Where a datagram goes.
/// @throws std::invalid_argument when `address` is no IPv4 address.
[[nodiscard]] sockaddr_in endpoint(const std::string& address, std::uint32_t port);

/// An ordinary non-blocking IPv4 UDP socket that may broadcast.
class DatagramSocket {
 public:
  /// Bound to 0.0.0.0:`port`; 0 lets the kernel choose.
  /// @throws std::system_error.
  explicit DatagramSocket(std::uint32_t port);

  /// False when the kernel did not take it, for whatever reason: an interface that is down, a full
  /// queue, a firewall. A flying program goes on without.
  bool try_send(std::span<const char> payload, const sockaddr_in& to) noexcept;

  /// The next datagram, cut off at the buffer's size, if one is there. The result points into
  /// `buffer`. A datagram that does not fit gives a span as large as the buffer.
  [[nodiscard]] std::optional<std::span<const std::byte>> try_receive(
      std::span<std::byte> buffer) noexcept;

 private:
  posix::UniqueFd fd_;
};

}  // namespace cuscus::agent
