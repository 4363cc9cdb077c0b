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
  writer.publish_link(1, 2, {.received_dbm = -57.5F, .rate_kbps = 5'500, .sim_time_ms = 1500});
  writer.beat(99);

  CHECK(reader.tally(2)->received == 4);
  CHECK(reader.link(1, 2)->received_dbm == -57.5F);
  CHECK(reader.link(1, 2)->rate_kbps == 5'500);
  CHECK(reader.link(1, 2)->sim_time_ms == 1500);
  CHECK_FALSE(reader.link(2, 1));
  CHECK(reader.heartbeat() == 1);
  CHECK(reader.sim_time_ns() == 99);
}

TEST_CASE("every link, and frames to everybody and to nobody, are counted apart") {
  std::vector<Line> lines(RadioMemoryWriter::byte_size(2) / kCacheLine + 1);
  const std::span<std::byte> memory{lines[0].bytes, RadioMemoryWriter::byte_size(2)};
  RadioMemoryWriter writer{memory, 2};
  const RadioMemoryReader reader{memory};

  std::int32_t times = 0;
  for (std::uint32_t sender = 0; sender < 2; ++sender) {
    for (const std::int32_t receiver : {0, 1, kToGroup, kToNobody}) {
      writer.link_tally(sender, receiver).count(LinkCount::kLostNoise, ++times);
    }
  }
  writer.link_tally(1, 0).note_rate(54'000);
  writer.link_tally(1, 0).note_rate(1'000);
  writer.link_tally(1, 0).note_rate(11'000);

  times = 0;
  for (std::uint32_t sender = 0; sender < 2; ++sender) {
    for (const std::int32_t receiver : {0, 1, kToGroup, kToNobody}) {
      CHECK(reader.link_tally(sender, receiver)[LinkCount::kLostNoise] ==
            static_cast<std::uint32_t>(++times));
      CHECK(reader.link_tally(sender, receiver)[LinkCount::kReceived] == 0);
    }
  }
  CHECK(reader.link_tally(1, 0).rates.latest_kbps == 11'000);
  CHECK(reader.link_tally(1, 0).rates.lowest_kbps == 1'000);
  CHECK(reader.link_tally(1, 0).rates.highest_kbps == 54'000);
}

}  // namespace
}  // namespace cuscus::shm
