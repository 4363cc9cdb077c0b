#include "ground-station/core/http_guard.h"

#include <algorithm>
#include <charconv>

namespace cuscus::gcs {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

bool is_port(std::string_view text) {
  constexpr unsigned kHighest = 65535;
  unsigned port = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, port);
  return error == std::errc{} && stop == end && port >= 1 && port <= kHighest;
}

}  // namespace

bool is_own_host(std::string_view host) {
  const std::size_t colon = host.find(':');
  if (colon != std::string_view::npos && !is_port(host.substr(colon + 1))) {
    return false;
  }
  const std::string_view name = host.substr(0, colon);
  return name == "127.0.0.1" || equal_ignoring_case(name, "localhost");
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return is_own_host(host) && origin.substr(0, kScheme.size()) == kScheme &&
         equal_ignoring_case(origin.substr(kScheme.size()), host);
}

Judgement judge(const RequestHead& request) {
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  const auto answer = [&](unsigned status, Route route = Route::kFile) {
    return Judgement{.status = status, .route = route, .path = path};
  };
  if (request.hosts != 1 || !is_own_host(request.host)) {
    return answer(421);
  }
  if (request.method != "GET" && request.method != "HEAD") {
    return answer(405);
  }
  if (path == "/ws") {
    if (request.origin && !is_own_origin(*request.origin, request.host)) {
      return answer(403, Route::kWebSocket);
    }
    return answer(request.is_upgrade ? 101 : 426, Route::kWebSocket);
  }
  if (request.is_upgrade) {
    return answer(400);
  }
  if (path == "/api/snapshot") {
    return answer(200, Route::kSnapshot);
  }
  return answer(200, path == "/api/city" ? Route::kCity : Route::kFile);
}

}  // namespace cuscus::gcs
