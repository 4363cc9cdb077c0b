#include "netsim/kernel/slot_pool.h"

#include <catch2/catch.hpp>
#include <iterator>
#include <string>

namespace cuscus::netsim {
namespace {

TEST_CASE("a pool gives a number to one owner at a time and uses it again") {
  SlotPool<std::string> pool;

  const std::uint32_t first = pool.take();
  const std::uint32_t second = pool.take();
  pool[first] = "first";
  pool[second] = "second";
  CHECK(first != second);
  CHECK(pool.in_use() == 2);

  pool.give_back(first);
  CHECK(pool.in_use() == 1);
  const std::uint32_t again = pool.take();
  CHECK(again == first);
  CHECK(pool[again] == "first");  // its memory is kept
  CHECK(pool[second] == "second");
  CHECK(std::distance(pool.begin(), pool.end()) == 2);
}

}  // namespace
}  // namespace cuscus::netsim
