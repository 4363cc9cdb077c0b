#pragma once

#include <cstdint>

#include "netsim/phy/receiver.h"

namespace cuscus::netsim {

/// What became of a node's frames since the run began.
///
/// Every offered frame ends in exactly one of: sent (group frames, and all of TDMA), acknowledged,
/// dropped_*, or is still under way. Every transmission of a group frame counts once at every other
/// node, as received or with the one cause of its loss; an individually addressed frame counts once
/// at its destination, with the cause of its last attempt if none got through.
struct Tally {
  std::uint64_t offered{};
  std::uint64_t transmissions{};  ///< Data frames put on the air, retries included.
  std::uint64_t retries{};
  std::uint64_t sent{};  ///< Put on the air once, and nobody is asked whether it arrived.
  std::uint64_t acknowledged{};
  std::uint64_t received{};
  std::uint64_t dropped_queue_full{};
  std::uint64_t dropped_lifetime{};
  std::uint64_t dropped_retry_limit{};
  std::uint64_t dropped_too_long{};  ///< Fits into no slot: TDMA only.
  std::uint64_t lost_below_floor{};
  std::uint64_t lost_below_detection{};
  std::uint64_t lost_noise{};
  std::uint64_t lost_collision{};
  std::uint64_t lost_interference{};
  std::uint64_t lost_half_duplex{};
  std::uint64_t lost_jammed{};

  void count(LossCause cause) {
    switch (cause) {
      case LossCause::kNone:
        break;
      case LossCause::kBelowFloor:
        ++lost_below_floor;
        break;
      case LossCause::kBelowDetection:
        ++lost_below_detection;
        break;
      case LossCause::kNoise:
        ++lost_noise;
        break;
      case LossCause::kCollision:
        ++lost_collision;
        break;
      case LossCause::kInterference:
        ++lost_interference;
        break;
      case LossCause::kHalfDuplex:
        ++lost_half_duplex;
        break;
      case LossCause::kJammed:
        ++lost_jammed;
        break;
    }
  }
};

}  // namespace cuscus::netsim
