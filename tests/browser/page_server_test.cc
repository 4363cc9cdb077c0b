#include "ground-station/app/page_server.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <catch2/catch.hpp>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/posix/check.h"

namespace cuscus::gcs {
namespace {

using asio::ip::tcp;

/// A page server on a loopback port that the kernel chose, on a thread of its own.
class RunningServer {
 public:
  explicit RunningServer(PageLimits limits, const std::string& picture = "{}") {
    posix::UniqueFd listener{
        posix::check("socket", ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0))};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    posix::check("bind",
                 ::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address));
    posix::check("listen", ::listen(listener.get(), SOMAXCONN));
    socklen_t size = sizeof address;
    posix::check("getsockname",
                 ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size));
    port_ = ntohs(address.sin_port);
    server_.emplace(
        io_, std::move(listener), [picture] { return picture; }, "null", census_, limits);
    asio::co_spawn(io_, server_->accept(), [](const std::exception_ptr&) {});
    thread_ = std::jthread{[this] { io_.run(); }};
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  RunningServer(RunningServer&&) = delete;
  RunningServer& operator=(RunningServer&&) = delete;
  ~RunningServer() { io_.stop(); }

  /// A connection whose reads and writes wait.
  tcp::socket connect() {
    tcp::socket socket{client_io_};
    socket.connect({asio::ip::address_v4::loopback(), port_});
    return socket;
  }

  /// Runs `body(server, census)` on the server's thread.
  template <typename Body>
  void with(Body body) {
    std::promise<void> done;
    asio::post(io_, [&] {
      body(*server_, census_);
      done.set_value();
    });
    done.get_future().wait();
  }

 private:
  PageCensus census_;
  asio::io_context io_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_{io_.get_executor()};
  asio::io_context client_io_;
  std::optional<PageServer> server_;
  std::uint16_t port_{0};
  std::jthread thread_;
};

/// Everything until the other end closes.
std::string read_all(tcp::socket& socket) {
  std::string text;
  boost::system::error_code error;
  asio::read(socket, asio::dynamic_buffer(text), error);
  return text;
}

std::string exchange(RunningServer& server, const std::string& request) {
  tcp::socket socket = server.connect();
  asio::write(socket, asio::buffer(request));
  return read_all(socket);
}

constexpr const char* kUpgrade =
    "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

/// Asks for a WebSocket and gives the status line.
std::string upgrade(tcp::socket& socket) {
  asio::write(socket, asio::buffer(std::string{kUpgrade}));
  std::string text;
  asio::read_until(socket, asio::dynamic_buffer(text), "\r\n\r\n");
  return text.substr(0, text.find("\r\n"));
}

TEST_CASE("what is not HTTP is refused, and the server goes on") {
  RunningServer server{{}};

  for (const std::string& garbage :
       {std::string{"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 TLS\r\n\r\n", 19},
        std::string{"GET / HTTP/9.9\r\n\r\n"}, std::string{"\0\0\0\0\r\n\r\n", 8},
        "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n"}) {
    const std::string answer = exchange(server, garbage);
    CHECK((answer.empty() || answer.substr(0, 10) == "HTTP/1.1 4"));
  }

  const std::string page =
      exchange(server, "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  CHECK(page.substr(0, 15) == "HTTP/1.1 200 OK");
  CHECK(page.find("<!doctype html>") != std::string::npos);
}

TEST_CASE("a body, a foreign host and a spoofed second host are refused") {
  RunningServer server{{}};

  CHECK(exchange(server, "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello")
            .substr(0, 12) == "HTTP/1.1 400");
  CHECK(exchange(server, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n").substr(0, 12) ==
        "HTTP/1.1 421");
  CHECK(exchange(server, "GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n")
            .substr(0, 12) == "HTTP/1.1 421");
}

TEST_CASE("a request that never ends is cut off") {
  RunningServer server{{.request_timeout = std::chrono::milliseconds{50}}};
  tcp::socket silent = server.connect();
  tcp::socket slow = server.connect();
  asio::write(slow, asio::buffer(std::string{"GET / HTTP/1.1\r\nHost: loc"}));

  CHECK(read_all(silent).empty());  // both return because the server closed
  CHECK(read_all(slow).empty());
}

TEST_CASE("no more clients than allowed get pictures") {
  RunningServer server{{.clients = 2}};
  std::vector<tcp::socket> sockets;
  sockets.reserve(3);
  for (int i = 0; i < 3; ++i) {
    sockets.push_back(server.connect());
  }

  CHECK(upgrade(sockets[0]) == "HTTP/1.1 101 Switching Protocols");
  CHECK(upgrade(sockets[1]) == "HTTP/1.1 101 Switching Protocols");
  CHECK(upgrade(sockets[2]) == "HTTP/1.1 503 Service Unavailable");
}

TEST_CASE("a client beyond the connections allowed is closed, not kept waiting") {
  RunningServer server{{.connections = 1}};
  tcp::socket first = server.connect();
  CHECK(upgrade(first) == "HTTP/1.1 101 Switching Protocols");

  tcp::socket second = server.connect();
  CHECK(read_all(second).empty());
}

TEST_CASE("a client that does not read holds up nobody and nothing piles up") {
  // More than the kernel's buffers of both ends can hold (tcp_wmem and tcp_rmem, at most 4 and
  // 6 MiB by default), so that its sending stays under way.
  const std::string large(16 << 20, 'x');
  // The raw sockets here answer no close frame: give up on one quickly.
  RunningServer server{{.request_timeout = std::chrono::milliseconds{300}}, large};
  tcp::socket stuck = server.connect();
  CHECK(upgrade(stuck) == "HTTP/1.1 101 Switching Protocols");

  std::array<char, 1> begun;
  asio::read(stuck, asio::buffer(begun));
  std::uint64_t dropped = 0;
  for (int i = 0; i < 50; ++i) {
    server.with([&](PageServer& page, PageCensus&) { page.publish(large); });
  }
  tcp::socket other = server.connect();
  CHECK(upgrade(other) == "HTTP/1.1 101 Switching Protocols");
  server.with([&](PageServer& page, PageCensus&) { page.end("last"); });

  // The other one gets its first picture and the last one, whatever the stuck one does.
  const std::string seen = read_all(other);
  CHECK(seen.find("last") != std::string::npos);
  // Having read at last, the stuck one gets on with the last and not with the fifty between.
  const std::string late = read_all(stuck);
  CHECK(late.find("last") != std::string::npos);
  CHECK(late.size() < 2 * large.size());
  server.with([&](PageServer&, PageCensus& census) { dropped = census.pictures_dropped; });
  CHECK(dropped == 50);
}

TEST_CASE("an overlong message ends its client only") {
  RunningServer server{{.inbound_bytes = 1000}};
  tcp::socket socket = server.connect();
  CHECK(upgrade(socket) == "HTTP/1.1 101 Switching Protocols");
  // A masked binary frame that announces 1 MiB (RFC 6455, section 5.2).
  const std::string frame{"\x82\xFF\0\0\0\0\0\x10\0\0\0\0\0\0", 14};
  asio::write(socket, asio::buffer(frame));

  // Close frames are answered by nobody here: the server closes once it has given up on us.
  boost::system::error_code error;
  std::string text;
  asio::read_until(socket, asio::dynamic_buffer(text), "\x88",
                   error);  // a close frame's first byte
  CHECK(!error);
}

}  // namespace
}  // namespace cuscus::gcs
