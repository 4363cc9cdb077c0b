#include "ground-station/app/telemetry_socket.h"

#include <boost/asio/buffer.hpp>

#include "ground-station/core/telemetry.h"

namespace cuscus::gcs {

TelemetrySocket::TelemetrySocket(asio::io_context& io, std::uint16_t port, Receiver receiver)
    : socket_{io, {asio::ip::udp::v4(), port}}, receiver_{std::move(receiver)} {
  static_assert(sizeof buffer_ > kLongestTelemetry_bytes);
}

asio::awaitable<void> TelemetrySocket::receive() {
  for (;;) {
    boost::system::error_code error;
    const std::size_t size = co_await socket_.async_receive(asio::buffer(buffer_), into(error));
    if (error == asio::error::operation_aborted) {
      co_return;
    }
    // Any other error is one that an ICMP message left on the socket: it concerns no datagram.
    if (!error) {
      receiver_(std::span{buffer_}.first(size));
    }
  }
}

}  // namespace cuscus::gcs
