#include "netsim/app/neighbour_readings.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>

#include "tests/unit/netsim/app/instants.h"

namespace cuscus::netsim {
namespace {

class Nobody final : public AirListener {
 public:
  void delivered(const Delivery& /*delivery*/) override {}
  void finished(const FrameReport& /*report*/) override {}
};

/// Nodes at 0, 30, 60 m and far away; node 1 has a program that asks its radio.
struct AskedRadio {
  static constexpr std::uint32_t kNodes = 4;

  AskedRadio() {
    const DecibelMilliwatt noise{-93.97};
    std::vector<std::optional<shm::RadioReadingsWriter>> writers(kNodes);
    writers[1].emplace(memory, kNodes,
                       static_cast<float>(reception_threshold(parameters(), noise).value));
    readings.emplace(std::move(writers), noise);
    air.emplace(parameters(), positions, nobody, &*readings);
  }
  static AirParameters parameters() {
    AirParameters parameters;
    parameters.nodes.assign(kNodes, AirNode{});
    return parameters;
  }
  shm::RadioReadingsReader reader() const { return shm::RadioReadingsReader{memory}; }

  alignas(64) std::array<std::byte, 1024> memory_bytes{};
  std::span<std::byte> memory =
      std::span{memory_bytes}.first(shm::RadioReadingsWriter::byte_size(kNodes));
  FixedPositions positions{
      {{0.0, 0.0, 20.0}, {30.0, 0.0, 20.0}, {60.0, 0.0, 20.0}, {20'000.0, 0.0, 20.0}}};
  Nobody nobody;
  std::optional<NeighbourReadings> readings;
  std::optional<Air> air;
};

TEST_CASE("a radio knows the level, SNR and rate of those whom it has decoded, and no others") {
  AskedRadio field;
  REQUIRE(shm::RadioReadingsWriter::byte_size(AskedRadio::kNodes) <= sizeof field.memory_bytes);

  field.air->offer(0, at_us(0), {.psdu_bytes = 128});
  // Not for it, but decoded all the same; its ACK names nobody.
  field.air->offer(2, at_us(1'000), {.destination = 0, .psdu_bytes = 128});
  // -110 dBm: heard as energy alone.
  field.air->offer(3, at_us(5'000), {.psdu_bytes = 128});
  field.air->run_until(at_us(10'000));

  const auto reader = field.reader();
  const auto near = reader.neighbour(0).value();
  // Friis at 2.412 GHz and 30 m: 16.02 dBm - 69.64 dB, over -93.97 dBm of noise.
  CHECK(near.received_dbm == Approx(-53.62).margin(0.01));
  CHECK(near.mean_dbm == near.received_dbm);
  CHECK(near.snr_db == Approx(40.35).margin(0.01));
  CHECK(near.rate_kbps == 6'000);
  CHECK(near.frames == 1);
  CHECK(near.sim_time_ns == 252'100);  // DIFS, 202 us on the air, 30 m
  CHECK(reader.neighbour(2).value().frames == 1);
  CHECK_FALSE(reader.neighbour(1));
  CHECK_FALSE(reader.neighbour(3));
}

TEST_CASE("frames that collide tell nothing") {
  AskedRadio field;

  field.air->offer(0, at_us(0), {.psdu_bytes = 128});
  field.air->offer(2, at_us(0), {.psdu_bytes = 128});
  field.air->run_until(at_us(1'000));

  CHECK_FALSE(field.reader().neighbour(0));
  CHECK_FALSE(field.reader().neighbour(2));
}

TEST_CASE("the threshold is the highest of what detection asks for") {
  const DecibelMilliwatt noise{-94.0};
  AirParameters parameters;
  CHECK(reception_threshold(parameters, noise).value == -82.0);  // detection's minimum

  parameters.detection_minimum = {-99.0};
  CHECK(reception_threshold(parameters, noise).value == -90.0);  // 4 dB over the noise

  parameters.detection_minimum_sinr = {-20.0};
  CHECK(reception_threshold(parameters, noise).value == -99.0);
}

}  // namespace
}  // namespace cuscus::netsim
