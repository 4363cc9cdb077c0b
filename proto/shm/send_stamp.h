#pragma once

#include <array>
#include <cstdint>

namespace cuscus::shm {

/// One frame leaving a node's interface, as the tc egress program writes it into the fleet's BPF
/// ring buffer (Descriptors::KIND_SEND_STAMP_RING). Records are in the order of the sends.
struct SendStamp {
  /// Bytes of the frame's beginning that a stamp carries: the Ethernet header for the MAC, the rest
  /// to tell one frame from the next when the kernel lost one on the way.
  static constexpr std::uint32_t kHeadBytes = 48;

  std::uint64_t monotonic_ns;  ///< CLOCK_MONOTONIC (bpf_ktime_get_ns) at the interface's egress.
  std::uint32_t node;
  std::uint32_t frame_bytes;                  ///< Ethernet frame without FCS.
  std::array<std::uint8_t, kHeadBytes> head;  ///< Zero beyond the frame's end.
};

static_assert(sizeof(SendStamp) == 64);

}  // namespace cuscus::shm
