#include "common/posix/processors.h"

#include <catch2/catch.hpp>
#include <thread>
#include <vector>

namespace cuscus::posix {
namespace {

// Documentation/admin-guide/cpu-lists and the kernel's bitmap format ("%*pb").
TEST_CASE("a set of processors is written as the kernel reads it") {
  CHECK(processor_mask(std::vector<int>{}) == "0");
  CHECK(processor_mask(std::vector{0}) == "1");
  CHECK(processor_mask(std::vector{1, 3}) == "a");
  CHECK(processor_mask(std::vector{31}) == "80000000");
  CHECK(processor_mask(std::vector{32}) == "1,00000000");
  CHECK(processor_mask(std::vector{0, 4, 67}) == "8,00000000,00000011");
}

TEST_CASE("a thread that is pinned may use one processor, and its maker as many as before") {
  const std::vector<int> before = allowed_processors();
  REQUIRE_FALSE(before.empty());
  std::vector<int> pinned;
  std::jthread{[&] {
    CHECK(try_pin(before.back()));
    pinned = allowed_processors();
  }}.join();
  CHECK(pinned == std::vector{before.back()});
  CHECK(allowed_processors() == before);
}

TEST_CASE("nobody is pinned to a processor that does not exist") {
  const std::vector<int> before = allowed_processors();
  CHECK_FALSE(try_pin(-1));
  CHECK_FALSE(try_pin(8191));
  CHECK_FALSE(try_pin(8192));
  CHECK(allowed_processors() == before);
}

}  // namespace
}  // namespace cuscus::posix
