#include "orchestrator/fetch/overpass_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace cuscus::orchestrator {
namespace {

constexpr std::size_t kLongestMessage = 300;

std::invalid_argument bad_server(const std::string& url) {
  return std::invalid_argument{
      fmt::format("'{}' is no server; allowed: http://HOST[:PORT]/PATH or https://..., such as "
                  "https://overpass-api.de/api/interpreter",
                  url)};
}

bool is_host_letter(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return std::isalnum(byte) != 0 || letter == '.' || letter == '-';
}

bool is_path_letter(char letter) { return letter > ' ' && letter < '\x7f' && letter != '#'; }

/// With the characters that the page has as entities.
std::string decoded(std::string text) {
  constexpr std::array<std::pair<std::string_view, char>, 4> kEntities{
      {{"&quot;", '"'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}}};
  for (const auto& [entity, letter] : kEntities) {
    for (auto at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1)) {
      text.replace(at, entity.size(), 1, letter);
    }
  }
  return text;
}

/// Words between tags, each run of spaces as one, cut to a readable length.
std::string plain(std::string_view html) {
  std::string text;
  bool in_tag = false;
  for (const char letter : html) {
    if (letter == '<') {
      in_tag = true;
    } else if (letter == '>') {
      in_tag = false;
    } else if (!in_tag && (letter > ' ' || letter < '\0')) {
      text += letter;
    } else if (!text.empty() && text.back() != ' ') {
      text += ' ';
    }
  }
  while (!text.empty() && text.back() == ' ') {
    text.pop_back();
  }
  text = decoded(std::move(text));
  return text.size() > kLongestMessage ? text.substr(0, kLongestMessage) + " ..." : text;
}

}  // namespace

OverpassServer parse_server(const std::string& url) {
  OverpassServer server;
  std::string_view rest = url;
  if (rest.starts_with("https://")) {
    server.tls = true;
    rest.remove_prefix(8);
  } else if (rest.starts_with("http://")) {
    rest.remove_prefix(7);
  } else {
    throw bad_server(url);
  }
  const auto slash = std::min(rest.find('/'), rest.size());
  const std::string_view authority = rest.substr(0, slash);
  server.path = slash < rest.size() ? std::string{rest.substr(slash)} : "/";
  const auto colon = std::min(authority.find(':'), authority.size());
  server.host = authority.substr(0, colon);
  server.port = colon < authority.size() ? std::string{authority.substr(colon + 1)}
                                         : std::string{server.tls ? "443" : "80"};
  const bool port_is_good =
      !server.port.empty() && server.port.size() <= 5 &&
      std::all_of(server.port.begin(), server.port.end(),
                  [](unsigned char letter) { return std::isdigit(letter) != 0; }) &&
      std::stoi(server.port) >= 1 && std::stoi(server.port) <= 65535;
  if (!port_is_good || server.host.empty() ||
      !std::all_of(server.host.begin(), server.host.end(), is_host_letter) ||
      !std::all_of(server.path.begin(), server.path.end(), is_path_letter)) {
    throw bad_server(url);
  }
  return server;
}

std::string overpass_query(const DegreeBox& bounds, const QueryLimits& limits) {
  return fmt::format(
      "[out:xml][timeout:{}][maxsize:{}][bbox:{:.7f},{:.7f},{:.7f},{:.7f}];\n"
      "(\n"
      "  way[\"building\"]; relation[\"building\"];\n"
      "  way[\"building:part\"]; relation[\"building:part\"];\n"
      "  way[\"highway\"];\n"
      "  node[\"natural\"=\"tree\"];\n"
      "  way[\"natural\"=\"wood\"]; relation[\"natural\"=\"wood\"];\n"
      "  way[\"landuse\"=\"forest\"]; relation[\"landuse\"=\"forest\"];\n"
      ");\n"
      "(._;>;);\n"
      "out body;\n",
      limits.time.count(), limits.bytes, bounds.south, bounds.west, bounds.north, bounds.east);
}

std::string form_body(std::string_view query) {
  std::string body = "data=";
  for (const char letter : query) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isalnum(byte) != 0 || letter == '-' || letter == '.' || letter == '_') {
      body += letter;
    } else {
      fmt::format_to(std::back_inserter(body), "%{:02X}", static_cast<unsigned>(byte));
    }
  }
  return body;
}

std::string error_in_page(std::string_view html) {
  // Overpass' pages have a paragraph "<strong>Error</strong>: ..." for each error.
  const auto at = html.find(">Error</strong>");
  if (at == std::string_view::npos) {
    return plain(html.substr(0, 4 * kLongestMessage));
  }
  const auto from = html.find(':', at);
  const auto to = html.find("</p>", at);
  return from == std::string_view::npos || (to != std::string_view::npos && to < from)
             ? plain(html.substr(at + 1))
             : plain(html.substr(from + 1, to - from - 1));
}

std::string remark_in_tail(std::string_view osm_tail) {
  constexpr std::string_view kOpen = "<remark>";
  const auto at = osm_tail.rfind(kOpen);
  if (at == std::string_view::npos) {
    return {};
  }
  const auto to = osm_tail.find("</remark>", at);
  return plain(osm_tail.substr(at + kOpen.size(), to - at - kOpen.size()));
}

}  // namespace cuscus::orchestrator
