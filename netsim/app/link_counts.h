#pragma once

#include <cstdint>

#include "netsim/air/air.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::netsim {

/// Counts in radio memory, per directed link, what becomes of the frames meant for each node: the
/// same frames, and with the same causes, as the air's Tally per node. Once nothing is under way,
/// sums over links are the tallies.
class LinkCounts final : public AirMonitor {
 public:
  /// `memory` must outlive this object.
  explicit LinkCounts(shm::RadioMemoryWriter& memory) : memory_{&memory} {}

  void transmitted(const Ppdu& ppdu) override;
  void received(const Ppdu& ppdu, const Reception& reception) override;
  void unreached(const Ppdu& ppdu, std::uint32_t receiver) override;

  // What an AirListener is told.
  void delivered(const Delivery& delivery);
  void finished(const FrameReport& report);
  /// A frame that was delivered did not get into its receiver's interface.
  void lost_at_interface(std::uint32_t sender, std::uint32_t receiver);

 private:
  shm::RadioMemoryWriter* memory_;
};

}  // namespace cuscus::netsim
