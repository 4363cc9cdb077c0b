#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace cuscus::orchestrator {

/// Degrees of WGS-84.
struct DegreeBox {
  double west{0.0};
  double south{0.0};
  double east{0.0};
  double north{0.0};
};

/// Where an Overpass interpreter answers.
struct OverpassServer {
  std::string host;
  std::string port;
  std::string path;
  bool tls{false};
};

/// "http://HOST[:PORT]/PATH" or https. @throws std::invalid_argument
[[nodiscard]] OverpassServer parse_server(const std::string& url);

struct QueryLimits {
  std::chrono::seconds time{180};
  std::uint64_t bytes{512'000'000};
};

/// The query for what a city is made of within bounds, in Overpass QL: buildings, their parts,
/// streets, trees and woods, with all nodes of what they consist of.
[[nodiscard]] std::string overpass_query(const DegreeBox& bounds, const QueryLimits& limits);

/// The query as the body of an HTML form, as the interpreter wants it.
[[nodiscard]] std::string form_body(std::string_view query);

/// What the server says is wrong with the query or with itself: the text of its page of errors, or
/// the remark at the end of data that are not complete. Empty: nothing.
[[nodiscard]] std::string error_in_page(std::string_view html);
[[nodiscard]] std::string remark_in_tail(std::string_view osm_tail);

}  // namespace cuscus::orchestrator
