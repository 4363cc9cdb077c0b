#include "orchestrator/app/hang_watch.h"

#include <catch2/catch.hpp>

namespace cuscus::orchestrator {
namespace {

using namespace std::chrono_literals;

TEST_CASE("state and processor time are read from /proc/pid/stat, whatever the program's name") {
  const auto activity = parse_process_stat(
      "4711 (a ) S 1 (b) R 1 4711 4711 0 -1 4194560 100 0 0 0 250 50 0 0 20 0 1 0 1 2 3", 100);

  REQUIRE(activity);
  CHECK(activity->state == 'R');
  CHECK(activity->cpu == 3s);
  CHECK_FALSE(parse_process_stat("", 100));
  CHECK_FALSE(parse_process_stat("4711 (cut", 100));
}

TEST_CASE("a silent process hangs when it sleeps or loops, not when it is starved") {
  CHECK(HangWatch::is_hang(6s, 'S', 0s));
  CHECK(HangWatch::is_hang(6s, 'T', 0s));
  CHECK(HangWatch::is_hang(6s, 'R', 6s));
  CHECK_FALSE(HangWatch::is_hang(6s, 'R', 1s));
  CHECK_FALSE(HangWatch::is_hang(4s, 'S', 0s));
}

}  // namespace
}  // namespace cuscus::orchestrator
