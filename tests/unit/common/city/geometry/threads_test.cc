#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "common/city/geometry/city_geometry.h"
#include "tests/unit/common/city/geometry/houses.h"

namespace cuscus::city {
namespace {

TEST_CASE("threads that ask at once get what one gets") {
  const CityGeometry geometry{town_of_stars(3)};
  const auto count = [&geometry](std::uint64_t seed) {
    Draws draws{random::CounterStream{seed, 9}};
    Crossings found;
    std::uint32_t sum = 0;
    for (int i = 0; i < 200; ++i) {
      geometry.crossings(draws.place({0.0, 0.0, 0.0}, {300.0, 300.0, 40.0}),
                         draws.place({0.0, 0.0, 0.0}, {300.0, 300.0, 40.0}), found);
      for (const Crossing& crossing : found.buildings) {
        sum += crossing.outer_walls;
      }
    }
    return sum;
  };
  std::vector<std::uint32_t> at_once(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    threads.emplace_back([&, i] { at_once[i] = count(i); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }

  for (std::size_t i = 0; i < at_once.size(); ++i) {
    CHECK(at_once[i] == count(i));
    CHECK(at_once[i] > 100);
  }
}

}  // namespace
}  // namespace cuscus::city
