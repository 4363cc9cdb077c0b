#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <string>

#include "common/posix/unique_fd.h"
#include "ground-station/app/asio.h"

namespace cuscus::gcs {

/// What a page server lets strangers use up.
struct PageLimits {
  std::size_t connections{64};       ///< Open at once; more are closed at once.
  std::size_t clients{16};           ///< WebSockets among them.
  std::size_t header_bytes{8192};    ///< Of a request.
  std::size_t inbound_bytes{65536};  ///< Of a WebSocket message, whose content is ignored.
  /// From its first byte awaited to the last one of its answer sent.
  std::chrono::milliseconds request_timeout{10'000};
  std::chrono::milliseconds silence_timeout{20'000};  ///< A client that answers no ping is gone.
};

/// Who is connected now. Outlives the io_context, whose end destroys the connections.
struct PageCensus {
  std::size_t connections{0};
  std::list<asio::steady_timer*> clients;  ///< Each waits for the next picture on its timer.
  std::uint64_t clients_ever{0};
  std::uint64_t pictures_dropped{0};  ///< That a slow client did not get.
};

/// The operator's page: static files, /api/snapshot, /api/city, and a WebSocket that carries
/// pictures.
///
/// Nothing is queued: a client that is still busy with one picture when the next one comes gets
/// the one that is newest when it is done.
class PageServer {
 public:
  using PictureSource = std::function<std::string()>;

  /// Takes over `listener`, a listening TCP socket. `city` is JSON.
  PageServer(asio::io_context& io, posix::UniqueFd listener, PictureSource source, std::string city,
             PageCensus& census, PageLimits limits = {});

  /// Accepts connections until end().
  [[nodiscard]] asio::awaitable<void> accept();

  /// Sends a picture to every client.
  void publish(std::string picture);
  /// Sends a last picture, closes the WebSockets and the listener.
  void end(std::string picture);

 private:
  class Connection;

  asio::ip::tcp::acceptor acceptor_;
  PictureSource source_;
  std::string city_;
  PageCensus& census_;
  PageLimits limits_;
  std::string picture_;
  std::uint64_t generation_{0};  // of picture_
  bool ended_{false};
};

}  // namespace cuscus::gcs
