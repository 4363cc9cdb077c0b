#include "orchestrator/fetch/overpass_query.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "orchestrator/fetch/map_check.h"

namespace cuscus::orchestrator {

TEST_CASE("A server is a scheme, a host, maybe a port, and a path") {
  const OverpassServer plain = parse_server("http://127.0.0.1:8080/api/interpreter");
  REQUIRE(plain.host == "127.0.0.1");
  REQUIRE(plain.port == "8080");
  REQUIRE(plain.path == "/api/interpreter");
  REQUIRE_FALSE(plain.tls);

  const OverpassServer secure = parse_server("https://overpass.example");
  REQUIRE(secure.port == "443");
  REQUIRE(secure.path == "/");
  REQUIRE(secure.tls);
}

TEST_CASE("What is no server is refused with what one looks like") {
  for (const char* const url :
       {"", "overpass.example/api", "ftp://x/", "http://", "http:///api", "http://x:/",
        "http://x:0/", "http://x:65536/", "http://x:8o/", "http://user@x/", "http://x/a b",
        "http://x/\r\nHost: y", "http://x/#part"}) {
    CAPTURE(url);
    REQUIRE_THROWS_WITH(parse_server(url), Catch::Contains("allowed: http://HOST[:PORT]/PATH"));
  }
}

TEST_CASE("A query's letters that mean something in a form are escaped") {
  REQUIRE(form_body("[a=\"b\"];\n") == "data=%5Ba%3D%22b%22%5D%3B%0A");
}

TEST_CASE("Overpass' own words are found in its page of errors") {
  REQUIRE(error_in_page("<p>x</p><p><strong style=\"color:#FF0000\">Error</strong>: line 1: parse "
                        "error: ';' expected - 'x' found. </p><p>y</p>") ==
          "line 1: parse error: ';' expected - 'x' found.");
  REQUIRE(error_in_page("<strong>Error</strong>: Unknown type &quot;nod&quot; &amp;lt;</p>") ==
          "Unknown type \"nod\" &lt;");
  REQUIRE(error_in_page("<h1>Bad  Gateway</h1>\n") == "Bad Gateway");
  REQUIRE(error_in_page("").empty());
  REQUIRE(error_in_page(std::string(5000, 'x')).size() < 400);
  // Broken off wherever it may be.
  REQUIRE_NOTHROW(error_in_page("<strong>Error</strong>"));
  REQUIRE_NOTHROW(error_in_page("<strong>Error</strong></p>: x"));
}

TEST_CASE("An answer is a map when it begins and ends as one, without a remark") {
  const auto fault_of = [](std::initializer_list<std::string_view> pieces) {
    MapCheck check;
    for (const std::string_view piece : pieces) {
      check.take(piece);
    }
    return check.fault();
  };
  const std::string nodes(10'000, 'n');

  REQUIRE(fault_of({"<?xml?><o", "sm>", nodes, "</os", "m>\n"}).empty());
  REQUIRE_THAT(fault_of({"<html>Hello</html>"}), Catch::Contains("Hello"));
  REQUIRE_THAT(fault_of({}), Catch::Contains("no OpenStreetMap data"));
  REQUIRE_THAT(fault_of({"<osm>", nodes}), Catch::Contains("ends before"));
  REQUIRE(fault_of({"<osm>", nodes, "<rem", "ark> out of memory </remark></osm>"}) ==
          "the server gave up: out of memory");
}

}  // namespace cuscus::orchestrator
