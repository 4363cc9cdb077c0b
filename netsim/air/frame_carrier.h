#pragma once

#include <cstdint>
#include <optional>

#include "common/units/sim_time.h"
#include "netsim/air/tally.h"

namespace cuscus::netsim {

struct OfferedFrame;

/// What carries frames between the nodes of a run, as a discrete-event simulation that its caller
/// drives. No I/O, no clock, no thread; equal inputs give equal outputs.
class FrameCarrier {
 public:
  FrameCarrier() = default;
  FrameCarrier(const FrameCarrier&) = delete;
  FrameCarrier& operator=(const FrameCarrier&) = delete;
  FrameCarrier(FrameCarrier&&) = delete;
  FrameCarrier& operator=(FrameCarrier&&) = delete;
  virtual ~FrameCarrier() = default;

  /// A program on `node` sent a frame at `sent_at`; when that is before now(), it counts as now().
  virtual void offer(std::uint32_t node, SimTime sent_at, const OfferedFrame& frame) = 0;

  /// Runs one step if the first event is due by `limit`; false when it is not.
  virtual bool run_next(SimTime limit) = 0;
  /// Runs all events up to and including `limit`, which becomes now().
  virtual void run_until(SimTime limit) = 0;

  /// Of the latest event.
  [[nodiscard]] virtual SimTime now() const = 0;
  [[nodiscard]] virtual std::optional<SimTime> next_event() const = 0;
  /// No frame can be delivered before this, whatever is offered from now on is aside.
  [[nodiscard]] virtual std::optional<SimTime> next_delivery_bound() const = 0;

  [[nodiscard]] virtual std::uint32_t node_count() const = 0;
  /// Frames that may wait at a node.
  [[nodiscard]] virtual std::uint32_t queue_places() const = 0;
  [[nodiscard]] virtual const Tally& tally(std::uint32_t node) const = 0;
  [[nodiscard]] virtual std::uint64_t events() const = 0;
};

}  // namespace cuscus::netsim
