#pragma once

#include <cstdint>

namespace cuscus::netsim {

/// What comes first when several events have one time. A medium that becomes idle does so before it
/// becomes busy again, and a station that reaches its slot transmits before it hears who else did.
/// Jammers switch before all that.
enum class EventRank : std::uint8_t {
  kJamming,
  kOffer,
  kEnergyEnds,
  kFinish,
  kAccess,
  kSweep,
  kTimeout
};

[[nodiscard]] constexpr std::uint64_t event_rank(EventRank rank, std::uint32_t object) {
  return (static_cast<std::uint64_t>(rank) << 32U) | object;
}

}  // namespace cuscus::netsim
