#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/posix/unique_fd.h"
#include "proto/shm/send_stamp.h"

namespace cuscus::netsim {

/// The consumer's view of a BPF ring buffer that lies in memory, wherever that is.
///
/// Layout (kernel documentation, bpf/ringbuf): the data area is a power of two, mapped twice in a
/// row so that no record is ever cut. A record is a header of 8 bytes, whose first 4 are its length
/// with bit 31 "still being written" and bit 30 "discarded", then its bytes, padded to 8. Positions
/// count bytes and never wrap.
class RingReader {
 public:
  struct Memory {
    std::atomic<std::uint64_t>* consumer;
    const std::atomic<std::uint64_t>* producer;
    const std::byte* data;
    std::uint64_t byte_size;  ///< Of the data area, once.
  };

  explicit RingReader(const Memory& memory) : memory_{memory} {}

  /// Where the records that have a place in the ring by now end.
  [[nodiscard]] std::uint64_t end() const {
    return memory_.producer->load(std::memory_order_acquire);
  }
  /// The next stamp before `end`, taken off the ring; nothing when there is none, or when
  /// blocked().
  std::optional<shm::SendStamp> next(std::uint64_t end);

  /// Whether the next record has a place but is not written yet: others may wait behind it.
  [[nodiscard]] bool blocked() const { return blocked_; }
  /// Whether there is nothing to read. Orders itself after what was consumed, so that a producer
  /// who writes after this wakes a sleeper.
  [[nodiscard]] bool empty() const;
  /// Records that were no stamps.
  [[nodiscard]] std::uint64_t foreign() const { return foreign_; }

 private:
  Memory memory_;
  bool blocked_{false};
  std::uint64_t foreign_{0};
};

/// The fleet's ring of send stamps, mapped. (A BPF map needs no bpf() right to be mapped and
/// polled.)
class StampRing {
 public:
  /// Takes over the descriptor of a map of type BPF_MAP_TYPE_RINGBUF.
  /// @throws std::system_error, std::runtime_error when it is no such map.
  explicit StampRing(posix::UniqueFd map);
  StampRing(const StampRing&) = delete;
  StampRing& operator=(const StampRing&) = delete;
  StampRing(StampRing&&) = delete;
  StampRing& operator=(StampRing&&) = delete;
  ~StampRing();

  [[nodiscard]] RingReader& reader() { return *reader_; }
  /// For epoll: readable when the producer wrote to a ring that had been emptied.
  [[nodiscard]] int fd() const { return map_.get(); }

 private:
  posix::UniqueFd map_;
  void* consumer_page_{nullptr};
  void* producer_pages_{nullptr};
  std::size_t page_bytes_{0};
  std::size_t producer_bytes_{0};
  std::optional<RingReader> reader_;
};

}  // namespace cuscus::netsim
