#pragma once

#include <cstdint>

#include "netsim/air/air_monitor.h"

namespace cuscus::netsim {

/// A PPDU as one node has it: its own, or one that it received or failed to.
struct PpduRecord {
  std::uint32_t node{};
  bool own{};
  Ppdu ppdu{};
  Reception reception{};  ///< Unless it is its own.

  /// When a card would tell of it: its own when it begins, another's when it is over.
  [[nodiscard]] SimTime time() const { return own ? ppdu.begins : reception.time; }
  [[nodiscard]] bool failed() const { return !own && reception.cause != LossCause::kNone; }
};

/// Whether building the frame takes the Ethernet frame that it is sent for.
[[nodiscard]] constexpr bool needs_payload(const Ppdu& ppdu) {
  return ppdu.frame.kind == MacFrame::Kind::kData || ppdu.frame.kind == MacFrame::Kind::kRts;
}

/// Whether a receiver had begun to decode it when it failed: such a frame, and no other, a card can
/// hand up with its FCS wrong.
[[nodiscard]] constexpr bool fails_by_fcs(LossCause cause) {
  return cause == LossCause::kNoise || cause == LossCause::kInterference ||
         cause == LossCause::kJammed;
}

}  // namespace cuscus::netsim
