#include "uav-agent/missions/neighbour_table.h"

#include <algorithm>
#include <stdexcept>

namespace cuscus::missions {

NeighbourTable::NeighbourTable(std::uint32_t own_slot, std::uint32_t fleet_size,
                               SimClock::duration timeout)
    : own_slot_{own_slot}, timeout_{timeout}, entries_(fleet_size) {
  if (own_slot >= fleet_size) {
    throw std::invalid_argument{"slot " + std::to_string(own_slot) + " in a fleet of " +
                                std::to_string(fleet_size)};
  }
}

NeighbourTable::Verdict NeighbourTable::accept(const NeighbourReport& report, SimTime now) {
  if (report.slot >= entries_.size()) {
    return Verdict::kUnknown;
  }
  if (report.slot == own_slot_) {
    return Verdict::kOwn;
  }
  if (!report.p_WB_m.allFinite() || report.p_WB_m.cwiseAbs().maxCoeff() > kDistanceMax_m ||
      report.time < SimTime{} || report.time > now + kFutureMax) {
    return Verdict::kMalformed;
  }
  auto& entry = entries_[report.slot];
  if (entry && now - entry->heard <= timeout_) {
    const std::uint32_t ahead = report.sequence - entry->report.sequence;
    const bool newer = ahead != 0 && ahead < (1U << 31U);
    if (!newer || report.time < entry->report.time) {
      return Verdict::kOld;
    }
  }
  entry = Entry{.report = report, .heard = now};
  return Verdict::kAccepted;
}

std::optional<NeighbourReport> NeighbourTable::heard(std::uint32_t slot, SimTime now) const {
  if (slot >= entries_.size() || !entries_[slot] || now - entries_[slot]->heard > timeout_) {
    return std::nullopt;
  }
  return entries_[slot]->report;
}

std::uint32_t NeighbourTable::heard_count(SimTime now) const {
  std::uint32_t count = 0;
  for (std::uint32_t slot = 0; slot < fleet_size(); ++slot) {
    count += heard(slot, now) ? 1U : 0U;
  }
  return count;
}

}  // namespace cuscus::missions
