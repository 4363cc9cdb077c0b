#include "common/scenario/utc.h"

#include <catch2/catch.hpp>

namespace cuscus::scenario {
namespace {

TEST_CASE("an instant in UTC is read and written as ISO 8601 has it") {
  // `date -u -d 2026-01-01T12:00:00Z +%s` and of a leap day.
  CHECK(parse_utc("2026-01-01T12:00:00Z").value().time_since_epoch().count() == 1'767'268'800);
  CHECK(parse_utc("2024-02-29T23:59:59Z").value().time_since_epoch().count() == 1'709'251'199);
  for (const char* const text : {"1980-01-06T00:00:00Z", "2024-02-29T23:59:59Z"}) {
    CHECK(format_utc(parse_utc(text).value()) == text);
  }
}

TEST_CASE("what is no instant in UTC is not read") {
  for (const char* const text :
       {"", "now", "2026-01-01", "2026-01-01T12:00:00", "2026-01-01T12:00:00+01:00",
        "2026-01-01 12:00:00Z", "2026-02-29T12:00:00Z", "2026-13-01T12:00:00Z",
        "2026-01-01T24:00:00Z", "2026-01-01T12:60:00Z", "2026-01-01T12:00:60Z",
        "1979-12-31T23:59:59Z", "2100-01-01T00:00:00Z", "2026-1-01T12:00:00Z ",
        "2026-01-01T-1:00:00Z"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_utc(text));
  }
}

}  // namespace
}  // namespace cuscus::scenario
