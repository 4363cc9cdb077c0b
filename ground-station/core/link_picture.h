#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/units/sim_time.h"
#include "ground-station/core/snapshot.h"

namespace cuscus::gcs {

/// A link is shown while its latest frame is no older than this.
inline constexpr SimClock::duration kLinkMemory = std::chrono::seconds{1};

/// Who hears whom, as the page shows it.
struct LinkPicture {
  std::vector<Snapshot::Link> strongest;  ///< One per pair, strongest first.
  std::size_t left_out = 0;               ///< Pairs beyond those.
  /// How many nodes each node heard, by its number; shorter than the fleet when the last heard
  /// none.
  std::vector<std::uint32_t> hears;
};

/// The picture of what was heard within kLinkMemory before `now`, with at most `most` pairs.
[[nodiscard]] LinkPicture link_picture(const Observation& observation, SimTime now,
                                       std::size_t most);

}  // namespace cuscus::gcs
