#include "ground-station/core/http_guard.h"

#include <catch2/catch.hpp>

namespace cuscus::gcs {
namespace {

RequestHead get(std::string_view target) {
  return {.method = "GET",
          .target = target,
          .hosts = 1,
          .host = "127.0.0.1:8080",
          .origin = std::nullopt,
          .is_upgrade = false};
}

RequestHead upgrade(std::string_view origin) {
  RequestHead head = get("/ws");
  head.origin = origin;
  head.is_upgrade = true;
  return head;
}

TEST_CASE("only this machine's own names are hosts") {
  for (const char* const host : {"127.0.0.1", "127.0.0.1:8080", "localhost", "LocalHost:1"}) {
    CHECK(is_own_host(host));
  }
  for (const char* const host :
       {"", "evil.example", "127.0.0.1.evil.example", "localhost.evil.example:8080", "127.0.0.2",
        "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:80x", "localhost:8080:1",
        "[::1]:8080", " localhost", "user@localhost", "localhost/"}) {
    CHECK_FALSE(is_own_host(host));
  }
}

TEST_CASE("a request for another host is misdirected, whatever it asks") {
  RequestHead head = get("/");
  head.host = "evil.example";
  CHECK(judge(head).status == 421);
  head = upgrade("http://127.0.0.1:8080");
  head.host = "evil.example:8080";
  CHECK(judge(head).status == 421);
  head = get("/");
  head.hosts = 0;
  CHECK(judge(head).status == 421);
  head.hosts = 2;
  CHECK(judge(head).status == 421);
}

TEST_CASE("only reading is allowed") {
  for (const char* const method : {"POST", "PUT", "DELETE", "OPTIONS", "CONNECT", "TRACE", "get"}) {
    RequestHead head = get("/");
    head.method = method;
    CHECK(judge(head).status == 405);
  }
  RequestHead head = get("/");
  head.method = "HEAD";
  CHECK(judge(head).status == 200);
}

TEST_CASE("a WebSocket is for our own page and for programs that are no browser") {
  CHECK(judge(upgrade("http://127.0.0.1:8080")).status == 101);
  RequestHead head = upgrade("");
  head.origin.reset();
  CHECK(judge(head).status == 101);

  for (const char* const origin :
       {"http://evil.example", "null", "", "https://127.0.0.1:8080", "http://127.0.0.1:9090",
        "http://127.0.0.1:8080.evil.example", "http://localhost:8080", "file://"}) {
    CHECK(judge(upgrade(origin)).status == 403);
  }
  CHECK(judge(get("/ws")).status == 426);
}

TEST_CASE("paths are told apart without their query") {
  CHECK(judge(get("/api/snapshot?x=1")).route == Route::kSnapshot);
  CHECK(judge(get("/api/city")).route == Route::kCity);
  CHECK(judge(get("/api/city/")).route == Route::kFile);
  CHECK(judge(get("/main.js?v=2")).path == "/main.js");
  CHECK(judge(get("/")).route == Route::kFile);
  CHECK(judge(get("/ws/../main.js")).route == Route::kFile);
  RequestHead head = get("/main.js");
  head.is_upgrade = true;
  CHECK(judge(head).status == 400);
}

}  // namespace
}  // namespace cuscus::gcs
