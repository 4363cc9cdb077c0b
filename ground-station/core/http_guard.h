#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cuscus::gcs {

/// What of an HTTP request decides whether and how it is answered.
struct RequestHead {
  std::string_view method;
  std::string_view target;
  /// Every Host header: more than one is an attack or a broken client.
  std::size_t hosts;
  std::string_view host;
  std::optional<std::string_view> origin;
  bool is_upgrade;  ///< To WebSocket.
};

enum class Route { kFile, kSnapshot, kCity, kWebSocket };

/// What to do with a request: `status` 200 (or 101 for the WebSocket) means to go on with `route`.
struct Judgement {
  unsigned status;
  Route route;
  std::string_view path;  ///< The target without its query.
};

/// Whether `host` is this machine's own name: 127.0.0.1 or localhost, with or without a port. Any
/// other means that a foreign name was made to point here (DNS rebinding).
[[nodiscard]] bool is_own_host(std::string_view host);

/// Whether a page from `origin` is one of ours: "http://" and the Host it was asked from. Browsers
/// do not forbid foreign pages to open WebSockets, so the server has to.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host);

/// In this order: 421 foreign Host, 405 method, then by path: 403 foreign Origin and 426 no upgrade
/// of /ws, 400 upgrade of anything else. Whether a file exists is for the caller.
[[nodiscard]] Judgement judge(const RequestHead& request);

}  // namespace cuscus::gcs
