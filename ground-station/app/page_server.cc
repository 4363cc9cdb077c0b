#include "ground-station/app/page_server.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <exception>
#include <string_view>

#include "common/log/log.h"
#include "ground-station/app/web_files.h"
#include "ground-station/core/http_guard.h"

namespace cuscus::gcs {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;
using WebSocket = websocket::stream<beast::tcp_stream>;

namespace {

std::string_view to_std(beast::string_view text) { return {text.data(), text.size()}; }

RequestHead head_of(const Request& request) {
  RequestHead head{.method = to_std(request.method_string()),
                   .target = to_std(request.target()),
                   .hosts = request.count(http::field::host),
                   .host = to_std(request[http::field::host]),
                   .origin = std::nullopt,
                   .is_upgrade = websocket::is_upgrade(request)};
  if (request.count(http::field::origin) != 0) {
    head.origin = to_std(request[http::field::origin]);
  }
  return head;
}

/// Headers that every answer has: no other site's code, no sniffing, no framing, no cache.
void harden(http::fields& fields) {
  fields.set(http::field::server, "cuscus");
  fields.set("Content-Security-Policy",
             "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
             "object-src 'none'");
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set(http::field::cache_control, "no-store");
}

Response text_response(unsigned status, unsigned version, std::string_view type, std::string body) {
  Response response{static_cast<http::status>(status), version};
  harden(response.base());
  response.set(http::field::content_type, beast::string_view{type.data(), type.size()});
  response.body() = std::move(body);
  return response;
}

Response refusal(unsigned status, unsigned version) {
  auto response = text_response(
      status, version, "text/plain; charset=utf-8",
      std::string{to_std(http::obsolete_reason(static_cast<http::status>(status)))} + "\n");
  if (status == 405) {
    response.set(http::field::allow, "GET, HEAD");
  }
  if (status == 426) {
    response.set(http::field::upgrade, "websocket");
  }
  return response;
}

}  // namespace

/// One TCP connection, from its acceptance to its end. Lives in its coroutine's frame.
class PageServer::Connection {
 public:
  Connection(PageServer& server, asio::ip::tcp::socket socket)
      : server_{server},
        census_{server.census_},
        web_socket_{std::move(socket)},
        wake_{web_socket_.get_executor(), asio::steady_timer::time_point::max()},
        writer_done_{web_socket_.get_executor(), asio::steady_timer::time_point::max()} {
    ++census_.connections;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  Connection(Connection&&) = delete;
  Connection& operator=(Connection&&) = delete;
  ~Connection() {
    --census_.connections;
    census_.clients.remove(&wake_);
  }

  asio::awaitable<void> run() {
    while (co_await answer_one()) {
    }
    error_code ignored;
    stream().socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  }

 private:
  beast::tcp_stream& stream() { return beast::get_lowest_layer(web_socket_); }

  /// Reads one request and answers it; false when the connection is at its end.
  asio::awaitable<bool> answer_one() {
    stream().expires_after(server_.limits_.request_timeout);
    http::request_parser<http::empty_body> parser;
    parser.header_limit(static_cast<std::uint32_t>(server_.limits_.header_bytes));
    error_code error;
    co_await http::async_read(stream(), buffer_, parser, into(error));
    if (error) {
      const bool is_protocol =
          error.category() == make_error_code(http::error::bad_method).category();
      if (is_protocol && error != http::error::end_of_stream) {
        auto response = refusal(error == http::error::header_limit ? 431 : 400, 11);
        co_await send(response, false);
      }
      co_return false;
    }
    const Request request = parser.release();
    const Judgement judgement = judge(head_of(request));
    if (judgement.status == 101 && census_.clients.size() < server_.limits_.clients &&
        !server_.ended_) {
      co_await serve_pictures(request);
      co_return false;
    }
    Response response = response_to(request, judgement);
    response.keep_alive(request.keep_alive() && response.result_int() == 200);
    co_return co_await send(response, request.method() == http::verb::head);
  }

  Response response_to(const Request& request, const Judgement& judgement) {
    if (judgement.status == 101) {
      return refusal(503, request.version());
    }
    if (judgement.status != 200) {
      return refusal(judgement.status, request.version());
    }
    if (judgement.route == Route::kSnapshot) {
      return text_response(200, request.version(), "application/json", server_.source_());
    }
    if (judgement.route == Route::kCity) {
      return text_response(200, request.version(), "application/json", server_.city_);
    }
    const auto file = find_web_file(judgement.path);
    if (!file) {
      return refusal(404, request.version());
    }
    return text_response(200, request.version(), file->content_type, std::string{file->text});
  }

  asio::awaitable<bool> send(Response& response, bool head_only) {
    response.prepare_payload();
    http::response_serializer<http::string_body> serializer{response};
    error_code error;
    if (head_only) {
      co_await http::async_write_header(stream(), serializer, into(error));
    } else {
      co_await http::async_write(stream(), serializer, into(error));
    }
    co_return !error && response.keep_alive();
  }

  asio::awaitable<void> serve_pictures(const Request& request) {
    stream().expires_never();  // the WebSocket has timeouts of its own
    web_socket_.set_option(
        websocket::stream_base::timeout{.handshake_timeout = server_.limits_.request_timeout,
                                        .idle_timeout = server_.limits_.silence_timeout,
                                        .keep_alive_pings = true});
    web_socket_.set_option(websocket::stream_base::decorator(
        [](websocket::response_type& response) { harden(response.base()); }));
    web_socket_.read_message_max(server_.limits_.inbound_bytes);
    census_.clients.push_back(&wake_);
    ++census_.clients_ever;
    error_code error;
    co_await web_socket_.async_accept(request, into(error));
    if (error) {
      co_return;
    }
    web_socket_.text(true);
    web_socket_.auto_fragment(false);  // one picture, one system call
    asio::co_spawn(web_socket_.get_executor(), write_pictures(), [this](const std::exception_ptr&) {
      writing_ = false;
      writer_done_.cancel();
    });
    writing_ = true;
    // Reading is what answers pings and sees the other end close.
    while (!error) {
      buffer_.clear();
      co_await web_socket_.async_read(buffer_, into(error));
    }
    reading_ = false;
    wake_.cancel();
    stream().cancel();
    while (writing_) {
      co_await writer_done_.async_wait(into(error));
    }
  }

  asio::awaitable<void> write_pictures() {
    std::uint64_t sent = server_.generation_;
    std::string picture = server_.ended_ ? server_.picture_ : server_.source_();
    error_code error;
    while (reading_) {
      co_await web_socket_.async_write(asio::buffer(picture), into(error));
      if (error) {
        co_return;
      }
      if (server_.ended_ && sent == server_.generation_) {
        co_await web_socket_.async_close(websocket::close_code::going_away, into(error));
        co_return;
      }
      while (sent == server_.generation_ && reading_) {
        co_await wake_.async_wait(into(error));
      }
      if (!reading_) {
        co_return;
      }
      census_.pictures_dropped += server_.generation_ - sent - 1;
      sent = server_.generation_;
      picture = server_.picture_;
    }
  }

  PageServer& server_;
  PageCensus& census_;  // the only thing outside that the destructor touches
  WebSocket web_socket_;
  asio::steady_timer wake_;
  asio::steady_timer writer_done_;
  beast::flat_buffer buffer_;
  bool reading_{true};
  bool writing_{false};
};

PageServer::PageServer(asio::io_context& io, posix::UniqueFd listener, PictureSource source,
                       std::string city, PageCensus& census, PageLimits limits)
    : acceptor_{io},
      source_{std::move(source)},
      city_{std::move(city)},
      census_{census},
      limits_{limits} {
  acceptor_.assign(asio::ip::tcp::v4(), listener.get());
  static_cast<void>(listener.release());
}

asio::awaitable<void> PageServer::accept() {
  constexpr auto kPause = std::chrono::milliseconds{100};
  while (!ended_) {
    error_code error;
    auto socket = co_await acceptor_.async_accept(into(error));
    if (error == asio::error::operation_aborted) {
      break;
    }
    if (error) {  // no descriptors left, for example: others may end and free some
      spdlog::warn("page: cannot accept a connection: {}", error.message());
      asio::steady_timer pause{acceptor_.get_executor(), kPause};
      co_await pause.async_wait(into(error));
      continue;
    }
    if (census_.connections >= limits_.connections) {
      continue;  // closes it
    }
    socket.set_option(asio::ip::tcp::no_delay{true}, error);
    asio::co_spawn(
        acceptor_.get_executor(),
        [](PageServer& server, asio::ip::tcp::socket accepted) -> asio::awaitable<void> {
          Connection connection{server, std::move(accepted)};
          co_await connection.run();
        }(*this, std::move(socket)),
        [](const std::exception_ptr& failure) {
          try {
            if (failure) {
              std::rethrow_exception(failure);
            }
          } catch (const std::exception& cause) {  // one connection's end is not the page's
            spdlog::warn("page: a connection failed: {}", cause.what());
          }
        });
  }
}

void PageServer::publish(std::string picture) {
  picture_ = std::move(picture);
  ++generation_;
  for (asio::steady_timer* const client : census_.clients) {
    client->cancel();
  }
}

void PageServer::end(std::string picture) {
  ended_ = true;
  publish(std::move(picture));
  error_code ignored;
  acceptor_.close(ignored);
}

}  // namespace cuscus::gcs
