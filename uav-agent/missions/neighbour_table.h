#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/units/sim_time.h"

namespace cuscus::missions {

/// Where a member of the fleet says that it was.
struct NeighbourReport {
  std::uint32_t slot = 0;
  std::uint32_t sequence = 0;  ///< Grows by one per report, wraps round.
  SimTime time;                ///< When the position was true.
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
};

/// What a UAV knows of the rest of its fleet: the newest report of each slot.
///
/// Reports come from the air and are trusted with nothing: what is not finite, too far away, from
/// the future, or older than what is known is refused.
class NeighbourTable {
 public:
  enum class Verdict {
    kAccepted,
    kOwn,        ///< One's own report, echoed.
    kUnknown,    ///< No such slot.
    kMalformed,  ///< Not finite, out of range, or from the future.
    kOld,        ///< Not newer than what is known.
  };

  /// Positions beyond this are nonsense.
  static constexpr double kDistanceMax_m = 1e5;
  /// Reports may be this far ahead of one's own clock.
  static constexpr SimClock::duration kFutureMax = std::chrono::milliseconds{100};

  /// A neighbour silent for longer than `timeout` is forgotten until it speaks again.
  NeighbourTable(std::uint32_t own_slot, std::uint32_t fleet_size, SimClock::duration timeout);

  /// Takes in a report that arrived at `now`. Sequence numbers are compared modulo 2^32; after a
  /// silence longer than the timeout any is taken, so that a restarted neighbour is heard.
  Verdict accept(const NeighbourReport& report, SimTime now);

  /// The newest report of `slot`, unless the slot has been silent for longer than the timeout.
  [[nodiscard]] std::optional<NeighbourReport> heard(std::uint32_t slot, SimTime now) const;

  /// Slots heard within the timeout.
  [[nodiscard]] std::uint32_t heard_count(SimTime now) const;

  [[nodiscard]] std::uint32_t own_slot() const { return own_slot_; }
  [[nodiscard]] std::uint32_t fleet_size() const {
    return static_cast<std::uint32_t>(entries_.size());
  }

 private:
  struct Entry {
    NeighbourReport report;
    SimTime heard;
  };

  std::uint32_t own_slot_;
  SimClock::duration timeout_;
  std::vector<std::optional<Entry>> entries_;
};

}  // namespace cuscus::missions
