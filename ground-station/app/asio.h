#pragma once

// Boost 1.74's awaitable.hpp uses std::exchange without including it: <utility> goes first.
// clang-format off
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
// clang-format on

namespace cuscus::gcs {

namespace asio = boost::asio;

/// Makes an operation awaitable that reports its error in `error` instead of throwing it.
[[nodiscard]] inline auto into(boost::system::error_code& error) {
  return asio::redirect_error(asio::use_awaitable, error);
}

}  // namespace cuscus::gcs
