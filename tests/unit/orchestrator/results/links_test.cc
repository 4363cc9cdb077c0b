#include "orchestrator/results/links.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace cuscus::orchestrator {
namespace {

using shm::LinkCount;

struct alignas(shm::kCacheLine) Line {
  std::array<std::byte, shm::kCacheLine> bytes;
};

std::vector<std::string> rows_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST_CASE("links.csv has a row per link that was used, causes and rates in columns") {
  std::vector<Line> memory(shm::RadioMemoryWriter::byte_size(2) / sizeof(Line) + 1);
  const auto bytes =
      std::as_writable_bytes(std::span{memory}).first(shm::RadioMemoryWriter::byte_size(2));
  shm::RadioMemoryWriter writer{bytes, 2};
  auto& link = writer.link_tally(1, 0);
  link.count(LinkCount::kReceived, 5);
  link.count(LinkCount::kLostCollision, 2);
  link.count(LinkCount::kDroppedQueueFull, 4);
  link.count(LinkCount::kDroppedRetryLimit, 2);
  link.count(LinkCount::kTransmissions, 20);
  link.note_rate(54'000);
  link.note_rate(6'000);
  writer.link_tally(1, shm::kToGroup).count(LinkCount::kTransmissions, 3);
  writer.link_tally(1, shm::kToNobody).count(LinkCount::kDroppedRetryLimit);

  const auto lines =
      rows_of(links_csv(std::vector<std::string>{"uav0", "uav1"}, shm::RadioMemoryReader{bytes}));

  REQUIRE(lines.size() == 4);
  CHECK(lines[0] ==
        "sender,receiver,frames,received,lost_below_floor,lost_below_detection,lost_noise,"
        "lost_collision,lost_interference,lost_half_duplex,lost_jammed,lost_interface,"
        "lost_unanswered,dropped_queue_full,dropped_lifetime,dropped_retry_limit,transmissions,"
        "rate_latest_kbps,rate_lowest_kbps,rate_highest_kbps");
  // 5 + 2 + 4 frames: those that met the retry limit are among the lost.
  CHECK(lines[1] == "uav1,uav0,11,5,0,0,0,2,0,0,0,0,0,4,0,2,20,6000,6000,54000");
  CHECK(lines[2] == "uav1,(group),,0,0,0,0,0,0,0,0,0,0,0,0,0,3,,,");
  CHECK(lines[3] == "uav1,(nobody),,0,0,0,0,0,0,0,0,0,0,0,0,1,0,,,");
}

}  // namespace
}  // namespace cuscus::orchestrator
