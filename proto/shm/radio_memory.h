#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "proto/shm/layout.h"
#include "proto/shm/link_tally.h"
#include "proto/shm/seqlock.h"

namespace cuscus::shm {

/// What became of a node's frames since the run began. A frame is counted once as sent; a
/// reception is counted once at each receiver that the frame was meant for.
struct RadioTally {
  std::uint64_t offered;        ///< Frames that the node's programs handed to its interface.
  std::uint64_t transmissions;  ///< Data frames put on the air, retries included.
  std::uint64_t retries;
  std::uint64_t acknowledged;  ///< Individually addressed frames confirmed by an ACK.
  std::uint64_t received;      ///< Frames delivered to the node's interface.
  // Frames the sender gave up, by cause.
  std::uint64_t dropped_queue_full;
  std::uint64_t dropped_lifetime;
  std::uint64_t dropped_retry_limit;
  std::uint64_t dropped_malformed;   ///< Too short, too long, not Ethernet II.
  std::uint64_t dropped_before_air;  ///< Sent, but lost between the interface and the emulator.
  // Receptions that failed at this node, by cause.
  std::uint64_t lost_below_floor;      ///< So weak that the receiver was left out of it.
  std::uint64_t lost_below_detection;  ///< Too weak for its preamble to be detected.
  std::uint64_t lost_noise;            ///< Detected, decoding failed without interference.
  std::uint64_t lost_collision;        ///< Not detected because of another frame.
  std::uint64_t lost_interference;     ///< Detected, and spoilt by other frames.
  std::uint64_t lost_half_duplex;      ///< The node was transmitting.
  std::uint64_t lost_jammed;           ///< Would have been received, had nobody jammed.
  /// Received, but the interface did not take it (down, full), or netsim was over 1 s late.
  std::uint64_t lost_interface;
};

/// How well the emulator keeps up.
struct RadioTiming {
  std::int64_t release_lateness_p50_ns;
  std::int64_t release_lateness_p99_ns;
  std::int64_t release_lateness_max_ns;
  std::uint64_t releases;
  std::uint64_t clamps;
  std::uint64_t events;
};

/// The latest data frame heard over one directed link.
struct LinkReading {
  float received_dbm;  ///< Kept to a hundredth.
  std::uint32_t rate_kbps;
  std::uint32_t sim_time_ms;
};

/// In the place of a receiver: group frames of a sender, and those to an address that nobody has.
inline constexpr std::int32_t kToGroup = -1;
inline constexpr std::int32_t kToNobody = -2;

/// What the air did: written by netsim, read by the page and the orchestrator.
struct RadioMemoryLayout {
  static constexpr std::uint64_t kMagic = magic_of("CUSRADIO");
  static constexpr std::uint32_t kVersion = 4;

  struct alignas(kCacheLine) Progress {
    std::atomic<std::uint64_t> heartbeat;
    std::atomic<std::int64_t> sim_time_ns;
    Seqlock<RadioTiming> timing;
  };
  struct alignas(kCacheLine) Slot {
    Seqlock<RadioTally> tally;
  };

  Header header;
  Progress progress;
  // node_count Slots follow, then a LinkTallySlot for each sender and receiver, sender-major, with
  // two more receivers for kToGroup and kToNobody; then node_count x node_count links,
  // receiver-major, each one word: level in hundredths of a dBm (16 bits), rate in 500 kb/s (16),
  // sim_time_ms (32); 0 where nothing was ever heard. 72 B per link: 0.7 MB for 100 nodes, 72 MB
  // for 1000.
};

class RadioMemoryWriter {
 public:
  [[nodiscard]] static std::size_t byte_size(std::uint32_t node_count);
  RadioMemoryWriter(std::span<std::byte> memory, std::uint32_t node_count);

  void publish(std::uint32_t node, const RadioTally& tally) noexcept;
  void publish(const RadioTiming& timing) noexcept;
  void publish_link(std::uint32_t receiver, std::uint32_t sender, LinkReading reading) noexcept;
  /// What is counted there is seen by readers at once. `receiver` may be kToGroup or kToNobody.
  [[nodiscard]] LinkTallySlot& link_tally(std::uint32_t sender, std::int32_t receiver) noexcept;
  /// Says that netsim lives and how far it has got.
  void beat(std::int64_t sim_time_ns) noexcept;

 private:
  RadioMemoryLayout* layout_;
  std::span<RadioMemoryLayout::Slot> slots_;
  std::span<LinkTallySlot> tallies_;
  std::span<std::atomic<std::uint64_t>> links_;
};

class RadioMemoryReader {
 public:
  /// @throws LayoutError when `memory` is not radio memory.
  explicit RadioMemoryReader(std::span<const std::byte> memory);

  [[nodiscard]] std::uint32_t node_count() const noexcept;
  [[nodiscard]] std::optional<RadioTally> tally(std::uint32_t node) const noexcept;
  [[nodiscard]] std::optional<RadioTiming> timing() const noexcept;
  /// Nothing when `receiver` never heard `sender`.
  [[nodiscard]] std::optional<LinkReading> link(std::uint32_t receiver,
                                                std::uint32_t sender) const noexcept;
  /// `receiver` may be kToGroup or kToNobody.
  [[nodiscard]] LinkTally link_tally(std::uint32_t sender, std::int32_t receiver) const noexcept;
  [[nodiscard]] std::uint64_t heartbeat() const noexcept;
  [[nodiscard]] std::int64_t sim_time_ns() const noexcept;

 private:
  const RadioMemoryLayout* layout_;
  std::span<const RadioMemoryLayout::Slot> slots_;
  std::span<const LinkTallySlot> tallies_;
  std::span<const std::atomic<std::uint64_t>> links_;
};

}  // namespace cuscus::shm
