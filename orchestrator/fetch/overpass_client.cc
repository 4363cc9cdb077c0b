#include "orchestrator/fetch/overpass_client.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <optional>

#include "orchestrator/fetch/map_check.h"

namespace cuscus::orchestrator {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Seconds = std::chrono::seconds;

constexpr Seconds kConnectTime{15};
constexpr Seconds kSpareTime{20};  // for the server's own queue and the way
constexpr std::size_t kPieceBytes = std::size_t{64} * 1024;
constexpr std::size_t kLongestErrorPage = std::size_t{64} * 1024;

/// One exchange. Each step is asynchronous for its time-out's sake, and waited for.
class OverpassExchange {
 public:
  OverpassExchange(const OverpassServer& server, const QueryLimits& limits)
      : server_{server}, limits_{limits} {}

  void run(const std::string& query, const std::function<void(std::string_view)>& take) {
    if (!server_.tls) {
      beast::tcp_stream stream{context_};
      connect(stream);
      ask(stream, query);
      receive(stream, take);
      return;
    }
    asio::ssl::context tls{asio::ssl::context::tls_client};
    tls.set_default_verify_paths();
    tls.set_verify_mode(asio::ssl::verify_peer);
    beast::ssl_stream<beast::tcp_stream> stream{context_, tls};
    stream.set_verify_callback(asio::ssl::host_name_verification{server_.host});
    // The name is for servers with several certificates. (SSL_set_tlsext_host_name() is a macro for
    // this, with casts of C.)
    std::string host = server_.host;
    if (::SSL_ctrl(stream.native_handle(), SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
                   host.data()) != 1) {
      throw FetchError{fmt::format("{}: TLS cannot ask for that name", name())};
    }
    connect(beast::get_lowest_layer(stream));
    wait("TLS", stream, kConnectTime,
         [&](auto done) { stream.async_handshake(asio::ssl::stream_base::client, done); });
    ask(stream, query);
    receive(stream, take);
  }

 private:
  [[nodiscard]] std::string name() const {
    return fmt::format("{}:{}", server_.host, server_.port);
  }

  /// Starts an operation and waits until it is done or its time is over.
  template <typename Stream, typename Start>
  void wait(const char* attempt, Stream& stream, Seconds time, const Start& start,
            beast::error_code allowed = {}) {
    beast::error_code result;
    beast::get_lowest_layer(stream).expires_after(time);
    start([&](beast::error_code error, auto&&...) { result = error; });
    context_.restart();
    context_.run();
    if (result == beast::error::timeout) {
      throw FetchError{
          fmt::format("{}: no answer within {} s ({})", name(), time.count(), attempt)};
    }
    if (result == http::error::body_limit) {
      throw too_large();
    }
    if (result && result != allowed) {
      throw FetchError{fmt::format("{}: {}: {}", name(), attempt, result.message())};
    }
  }

  void connect(beast::tcp_stream& stream) {
    beast::error_code error;
    const auto addresses =
        asio::ip::tcp::resolver{context_}.resolve(server_.host, server_.port, error);
    if (error) {
      throw FetchError{fmt::format("{}: no address: {}", name(), error.message())};
    }
    wait("connect", stream, kConnectTime,
         [&](auto done) { stream.async_connect(addresses, done); });
  }

  template <typename Stream>
  void ask(Stream& stream, const std::string& query) {
    http::request<http::string_body> request{http::verb::post, server_.path, 11};
    request.set(http::field::host, server_.host);
    request.set(http::field::user_agent, "cuscus/" CUSCUS_VERSION);
    request.set(http::field::accept_encoding, "identity");
    request.set(http::field::connection, "close");
    request.set(http::field::content_type, "application/x-www-form-urlencoded");
    request.body() = form_body(query);
    request.prepare_payload();
    wait("send the query", stream, kConnectTime,
         [&](auto done) { http::async_write(stream, request, done); });
  }

  template <typename Stream>
  void receive(Stream& stream, const std::function<void(std::string_view)>& take) {
    beast::flat_buffer buffer;
    http::response_parser<http::buffer_body> parser;
    parser.body_limit(limits_.bytes);
    wait("receive the answer", stream, limits_.time + kSpareTime,
         [&](auto done) { http::async_read_header(stream, buffer, parser, done); });
    const bool is_map = parser.get().result() == http::status::ok;
    MapCheck check;
    std::string page;
    std::array<char, kPieceBytes> piece;
    while (!parser.is_done()) {
      parser.get().body().data = piece.data();
      parser.get().body().size = piece.size();
      read_piece(stream, buffer, parser);
      const std::string_view got{piece.data(), piece.size() - parser.get().body().size};
      if (is_map) {
        check.take(got);
        take(got);
      } else if (page.size() < kLongestErrorPage) {
        page += got;
      } else {
        break;
      }
    }
    if (!is_map) {
      throw FetchError{refusal(parser.get(), page)};
    }
    if (const std::string fault = check.fault(); !fault.empty()) {
      throw FetchError{fmt::format("{}: {}", name(), fault)};
    }
  }

  template <typename Stream, typename Parser>
  void read_piece(Stream& stream, beast::flat_buffer& buffer, Parser& parser) {
    wait(
        "receive the answer", stream, limits_.time + kSpareTime,
        [&](auto done) { http::async_read(stream, buffer, parser, done); },
        http::error::need_buffer);
  }

  [[nodiscard]] FetchError too_large() const {
    return FetchError{

        fmt::format("{}: the answer is larger than {} MB; ask for a smaller area, or "
                    "allow more with --max-mb",
                    name(), limits_.bytes / 1'000'000)};
  }

  template <typename Response>
  [[nodiscard]] std::string refusal(const Response& response, const std::string& page) const {
    const unsigned code = response.result_int();
    if (code / 100 == 3) {
      const auto location = response[http::field::location];
      return fmt::format("{}: redirects to '{}', which is not followed; name it with --server",
                         name(), std::string_view{location.data(), location.size()});
    }
    const char* const hint = code == 429   ? " (too many queries: wait a little)"
                             : code == 504 ? " (the server is busy: wait a little)"
                                           : "";
    const std::string reason{http::obsolete_reason(response.result())};
    return fmt::format("{}: HTTP {} {}{}: {}", name(), code, reason, hint, error_in_page(page));
  }

  const OverpassServer& server_;
  const QueryLimits& limits_;
  asio::io_context context_;
};

}  // namespace

void fetch_map(const OverpassServer& server, const std::string& query, const QueryLimits& limits,
               const std::function<void(std::string_view)>& take) {
  OverpassExchange{server, limits}.run(query, take);
}

}  // namespace cuscus::orchestrator
