#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "netsim/mac/mac.h"

namespace cuscus::netsim {

/// One station of a time division multiple access (TDMA): it transmits in its own slots, whatever
/// the medium does, and nobody acknowledges.
///
/// - Slot k lasts from k T to (k + 1) T of SimTime and belongs to entry k mod n of a frame of n
///   slots. Clocks are perfect.
/// - A frame of airtime a starts at t in a slot that ends at e when t + a + guard <= e; else it
///   waits for the station's next slot. Frames of one slot follow one another without a gap, so
///   that a slot carries floor((T - guard) / a) of them.
/// - A transmission does not reach into a later slot at any receiver as long as the guard is no
///   shorter than the propagation delay (10 us: 3 km).
/// - The queue is in order of arrival and bounded; a frame that waited longer than the lifetime is
///   dropped. One that fits into no slot is refused when it comes.
/// - Individually addressed frames go out once, at the data rate, as group frames do at theirs.
///
/// The access scheme of EMANE's TDMA radio model, without its queues by priority, fragmentation
/// and changes of schedule; its slots are abstract, ours carry PPDUs of the standard.
class Tdma final : public Mac {
 public:
  /// `parameters` and `host` must outlive this object.
  Tdma(std::uint32_t node, const MacParameters& parameters, MacHost& host);

  void enqueue(SimTime now, const Msdu& msdu) override;
  void medium_busy(SimTime /*now*/) override {}
  void medium_idle(SimTime /*now*/) override {}
  void reception_started(SimTime /*now*/) override {}
  void reception_failed(SimTime /*now*/) override {}
  bool received(SimTime now, const MacFrame& frame, const Mode& mode) override;
  void transmission_ended(SimTime now) override;
  void timer(SimTime now, MacTimer timer) override;

 private:
  [[nodiscard]] const Mode& mode_of(const Msdu& msdu) const;
  /// From the start of its transmission to the end of the guard time behind it.
  [[nodiscard]] Duration needed(const Msdu& msdu) const;
  [[nodiscard]] SimTime earliest_start(SimTime now, const Msdu& msdu) const;
  void schedule_access(SimTime now);

  std::uint32_t node_;
  const MacParameters* parameters_;
  MacHost* host_;
  std::vector<std::int64_t> own_slots_;  ///< Places in the frame, rising.
  std::deque<Msdu> queue_;               ///< The front one is being sent.
  std::uint32_t sequence_{0};
  bool sending_{false};
};

}  // namespace cuscus::netsim
