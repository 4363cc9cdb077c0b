#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "ground-station/app/asio.h"

namespace cuscus::gcs {

/// The UDP port to which the fleet sends its telemetry.
class TelemetrySocket {
 public:
  using Receiver = std::function<void(std::span<const std::byte>)>;

  /// Binds to all addresses of the process's network namespace.
  /// @throws boost::system::system_error, when the port is taken for example.
  TelemetrySocket(asio::io_context& io, std::uint16_t port, Receiver receiver);

  /// Gives every datagram to the receiver, for as long as the io_context runs.
  [[nodiscard]] asio::awaitable<void> receive();

 private:
  asio::ip::udp::socket socket_;
  Receiver receiver_;
  // One byte more than the longest that could be good, so that a longer one is seen to be longer.
  std::array<std::byte, 513> buffer_{};
};

}  // namespace cuscus::gcs
