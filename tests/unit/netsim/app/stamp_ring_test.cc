#include "netsim/app/stamp_ring.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>

namespace cuscus::netsim {
namespace {

constexpr std::uint32_t kBusy = 1U << 31U;
constexpr std::uint32_t kDiscard = 1U << 30U;
constexpr std::uint64_t kBytes = 256;  // three records of 72 B and a bit

/// A BPF ring buffer as the kernel lays it out: the data area twice in a row. What is written in
/// one half is copied to the other, as the double mapping does by itself.
class FakeRing {
 public:
  std::uint64_t begin_record(std::uint32_t bytes, std::uint32_t flags) {
    const std::uint64_t position = producer.load();
    const std::uint32_t header = bytes | flags;
    write(position, &header, sizeof header);
    producer.store(position + (std::uint64_t{bytes} + 8 + 7) / 8 * 8);
    return position;
  }
  std::uint64_t push(std::uint64_t monotonic_ns, std::uint32_t flags = 0) {
    const std::uint64_t position = begin_record(sizeof(shm::SendStamp), flags);
    const shm::SendStamp stamp{
        .monotonic_ns = monotonic_ns, .node = 3, .frame_bytes = 60, .head = {}};
    write(position + 8, &stamp, sizeof stamp);
    return position;
  }
  void commit(std::uint64_t position) {
    const std::uint32_t header = sizeof(shm::SendStamp);
    write(position, &header, sizeof header);
  }

  std::optional<shm::SendStamp> next() { return reader.next(reader.end()); }

  std::atomic<std::uint64_t> consumer{0};
  std::atomic<std::uint64_t> producer{0};
  alignas(8) std::array<std::byte, 2 * kBytes> data{};

  RingReader reader{
      {.consumer = &consumer, .producer = &producer, .data = data.data(), .byte_size = kBytes}};

 private:
  void write(std::uint64_t position, const void* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte value = static_cast<const std::byte*>(bytes)[i];
      const std::size_t at = (position + i) & (kBytes - 1);
      data.at(at) = value;
      data.at(at + kBytes) = value;
    }
  }
};

TEST_CASE("stamps come in order and free their place, around the end of the ring") {
  FakeRing ring;
  for (std::uint64_t i = 1; i <= 20; ++i) {
    ring.push(i);
    ring.push(100 + i);

    CHECK_FALSE(ring.reader.empty());
    CHECK(ring.next().value().monotonic_ns == i);
    CHECK(ring.next().value().monotonic_ns == 100 + i);
    CHECK_FALSE(ring.next());
    CHECK(ring.reader.empty());
    CHECK(ring.consumer.load() == ring.producer.load());
  }
}

TEST_CASE("a record that is still being written blocks those behind it until it is whole") {
  FakeRing ring;
  const auto first = ring.push(1, kBusy);
  ring.push(2);

  CHECK_FALSE(ring.next());
  CHECK(ring.reader.blocked());
  CHECK_FALSE(ring.reader.empty());

  ring.commit(first);
  CHECK(ring.next().value().monotonic_ns == 1);
  CHECK_FALSE(ring.reader.blocked());
  CHECK(ring.next().value().monotonic_ns == 2);
}

TEST_CASE("what comes after a look at the ring's end is left for the next look") {
  FakeRing ring;
  ring.push(1);
  const std::uint64_t end = ring.reader.end();
  ring.push(2, kBusy);

  CHECK(ring.reader.next(end).value().monotonic_ns == 1);
  CHECK_FALSE(ring.reader.next(end));
  CHECK_FALSE(ring.reader.blocked());
  CHECK_FALSE(ring.next());
  CHECK(ring.reader.blocked());
}

TEST_CASE("discarded records and records of another size are skipped") {
  FakeRing ring;
  ring.push(1, kDiscard);
  ring.begin_record(16, 0);
  ring.push(3);

  CHECK(ring.next().value().monotonic_ns == 3);
  CHECK(ring.reader.foreign() == 1);
  CHECK(ring.reader.empty());
}

}  // namespace
}  // namespace cuscus::netsim
