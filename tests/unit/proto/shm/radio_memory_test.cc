#include "proto/shm/radio_memory.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

namespace cuscus::shm {
namespace {

struct alignas(kCacheLine) Line {
  std::byte bytes[kCacheLine];
};

TEST_CASE("radio memory carries tallies, links by direction and a heartbeat") {
  std::vector<Line> lines(RadioMemoryWriter::byte_size(3) / kCacheLine + 1);
  const std::span<std::byte> memory{lines[0].bytes, RadioMemoryWriter::byte_size(3)};
  RadioMemoryWriter writer{memory, 3};
  const RadioMemoryReader reader{memory};

  RadioTally tally{};
  tally.received = 4;
  writer.publish(2, tally);
  writer.publish_link(1, 2, {.received_dbm = -57.5F, .sim_time_ms = 1500});
  writer.beat(99);

  CHECK(reader.tally(2)->received == 4);
  CHECK(reader.link(1, 2)->received_dbm == -57.5F);
  CHECK(reader.link(1, 2)->sim_time_ms == 1500);
  CHECK_FALSE(reader.link(2, 1));
  CHECK(reader.heartbeat() == 1);
  CHECK(reader.sim_time_ns() == 99);
}

}  // namespace
}  // namespace cuscus::shm
