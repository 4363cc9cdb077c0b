#include "netsim/app/link_counts.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/unit/netsim/app/instants.h"

namespace cuscus::netsim {
namespace {

using shm::LinkCount;

struct alignas(shm::kCacheLine) Line {
  std::array<std::byte, shm::kCacheLine> bytes;
};

/// Nodes on a line, and what is counted per link of their air.
struct CountedAir final : public AirListener {
  CountedAir(std::vector<Eigen::Vector3d> p_WN, AirParameters parameters)
      : lines(shm::RadioMemoryWriter::byte_size(static_cast<std::uint32_t>(p_WN.size())) /
                  sizeof(Line) +
              1),
        memory{bytes(p_WN.size()), static_cast<std::uint32_t>(p_WN.size())},
        reader{bytes(p_WN.size())},
        positions{std::move(p_WN)},
        air{with_nodes(std::move(parameters)), positions, *this, &counts} {}

  void delivered(const Delivery& delivery) override { counts.delivered(delivery); }
  void finished(const FrameReport& report) override { counts.finished(report); }

  std::span<std::byte> bytes(std::size_t nodes) {
    return std::as_writable_bytes(std::span{lines})
        .first(shm::RadioMemoryWriter::byte_size(static_cast<std::uint32_t>(nodes)));
  }
  AirParameters with_nodes(AirParameters parameters) {
    parameters.nodes.assign(positions.positions({}).size(), AirNode{});
    return parameters;
  }
  std::uint64_t to_receiver(std::uint32_t receiver, LinkCount which) const {
    std::uint64_t sum = 0;
    for (std::uint32_t sender = 0; sender < reader.node_count(); ++sender) {
      sum += reader.link_tally(sender, static_cast<std::int32_t>(receiver))[which];
    }
    return sum;
  }
  std::uint64_t from_sender(std::uint32_t sender, LinkCount which) const {
    std::uint64_t sum = 0;
    for (std::int32_t to = shm::kToNobody; to < static_cast<std::int32_t>(reader.node_count());
         ++to) {
      sum += reader.link_tally(sender, to)[which];
    }
    return sum;
  }

  std::vector<Line> lines;
  shm::RadioMemoryWriter memory;
  shm::RadioMemoryReader reader;
  FixedPositions positions;
  LinkCounts counts{memory};
  Air air;
};

std::vector<Eigen::Vector3d> on_a_line(const std::vector<double>& x_m) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(x_m.size());
  for (const double x : x_m) {
    positions.emplace_back(x, 0.0, 20.0);
  }
  return positions;
}

TEST_CASE("sums over links are the tallies of the nodes, cause by cause") {
  // Some in range, some barely, one below the floor; more traffic than fits, so that queues fill
  // and frames grow old; fading, retries with and without RTS, jamming.
  AirParameters parameters;
  parameters.queue_frames = 20;
  parameters.queue_lifetime = std::chrono::milliseconds{15};
  parameters.rts_threshold_bytes = 900;
  parameters.group_rate_kbps = 24'000;  // detected further than decoded
  parameters.rate_control = "aarf";
  parameters.channel.fading = "rice";
  parameters.disruption.fraction = 0.05;
  CountedAir field{on_a_line({0.0, 300.0, 600.0, 900.0, 1'300.0, 60'000.0}), parameters};

  for (int i = 0; i < 6'000; ++i) {
    const auto node = static_cast<std::uint32_t>(i) % 6;
    const std::int32_t destination = i % 4 == 0    ? kGroup
                                     : i % 97 == 0 ? kNobody
                                                   : static_cast<std::int32_t>((node + 1) % 6);
    field.air.offer(node, at_us(std::int64_t{i} * 80),
                    {.destination = destination, .psdu_bytes = i % 5 == 0 ? 1'000U : 200U});
  }
  field.air.run_until(at_us(3'000'000));

  REQUIRE_FALSE(field.air.next_event());  // all is over
  const std::array receiver_side{
      std::pair{LinkCount::kReceived, &Tally::received},
      std::pair{LinkCount::kLostBelowFloor, &Tally::lost_below_floor},
      std::pair{LinkCount::kLostBelowDetection, &Tally::lost_below_detection},
      std::pair{LinkCount::kLostNoise, &Tally::lost_noise},
      std::pair{LinkCount::kLostCollision, &Tally::lost_collision},
      std::pair{LinkCount::kLostInterference, &Tally::lost_interference},
      std::pair{LinkCount::kLostHalfDuplex, &Tally::lost_half_duplex},
      std::pair{LinkCount::kLostJammed, &Tally::lost_jammed}};
  const std::array sender_side{
      std::pair{LinkCount::kDroppedQueueFull, &Tally::dropped_queue_full},
      std::pair{LinkCount::kDroppedLifetime, &Tally::dropped_lifetime},
      std::pair{LinkCount::kDroppedRetryLimit, &Tally::dropped_retry_limit},
      std::pair{LinkCount::kTransmissions, &Tally::transmissions}};
  for (const auto& [which, member] : receiver_side) {
    std::uint64_t all = 0;
    for (std::uint32_t node = 0; node < 6; ++node) {
      INFO("node " << node << ", count " << static_cast<int>(which));
      CHECK(field.to_receiver(node, which) == field.air.tally(node).*member);
      all += field.air.tally(node).*member;
    }
    INFO("count " << static_cast<int>(which));
    CHECK(all > 0);
  }
  for (const auto& [which, member] : sender_side) {
    std::uint64_t all = 0;
    for (std::uint32_t node = 0; node < 6; ++node) {
      INFO("node " << node << ", count " << static_cast<int>(which));
      CHECK(field.from_sender(node, which) == field.air.tally(node).*member);
      all += field.air.tally(node).*member;
    }
    INFO("count " << static_cast<int>(which));
    CHECK(all > 0);
  }
}

TEST_CASE("an individually addressed frame has one end on its link, whatever it was tried") {
  CountedAir field{on_a_line({0.0, 30.0, 100'000.0}), {}};

  field.air.offer(0, at_us(0), {.destination = 1, .psdu_bytes = 128});
  field.air.offer(0, at_us(0), {.destination = 2, .psdu_bytes = 128});
  field.air.run_until(at_us(1'000'000));

  const shm::LinkTally near = field.reader.link_tally(0, 1);
  CHECK(near[LinkCount::kReceived] == 1);
  CHECK(near[LinkCount::kTransmissions] == 1);
  const shm::LinkTally far = field.reader.link_tally(0, 2);
  CHECK(far[LinkCount::kLostBelowFloor] == 1);
  CHECK(far[LinkCount::kDroppedRetryLimit] == 1);
  CHECK(far[LinkCount::kTransmissions] == 7);
}

TEST_CASE("a link knows the latest, the lowest and the highest rate that it was used at") {
  // AARF steps up after ten successes in a row and down after two failures.
  AirParameters parameters;
  parameters.rate_control = "aarf";
  parameters.data_rate_kbps = 54'000;
  CountedAir field{on_a_line({0.0, 100'000.0}), parameters};

  field.air.offer(0, at_us(0), {.destination = 1, .psdu_bytes = 128});
  field.air.run_until(at_us(1'000'000));

  const shm::LinkRates rates = field.reader.link_tally(0, 1).rates;
  CHECK(rates.latest_kbps == rates.lowest_kbps);
  CHECK(rates.lowest_kbps < rates.highest_kbps);
  CHECK(field.reader.link_tally(1, 0).rates.latest_kbps == 0);
}

TEST_CASE("what does not get into an interface was not received there") {
  CountedAir field{on_a_line({0.0, 30.0}), {}};

  field.air.offer(0, at_us(0), {.psdu_bytes = 128});
  field.air.run_until(at_us(10'000));
  field.counts.lost_at_interface(0, 1);

  CHECK(field.reader.link_tally(0, 1)[LinkCount::kReceived] == 0);
  CHECK(field.reader.link_tally(0, 1)[LinkCount::kLostInterface] == 1);
}

}  // namespace
}  // namespace cuscus::netsim
