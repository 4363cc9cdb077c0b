#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/units/sim_time.h"
#include "netsim/app/due_copies.h"

namespace cuscus::netsim {

/// The two ports behind those of the nodes, when there are any: what is sent into one comes out of
/// the other a fixed delay after it was sent, past the air. Whoever is at both ends sees from that
/// how truthful the way through the host is (docs/fidelity.md).
class CanaryLink {
 public:
  /// `delay` of 0: there is no such link.
  CanaryLink(std::uint32_t node_count, SimClock::duration delay)
      : first_port_{node_count}, delay_{delay} {}

  [[nodiscard]] std::uint32_t port_count() const { return delay_.count() > 0 ? 2 : 0; }
  [[nodiscard]] bool has(std::uint32_t port) const { return port >= first_port_; }

  /// A frame has entered by one of the ports; in the order of their sends.
  void sent(std::uint32_t frame, std::uint32_t port, std::int64_t sent_ns) {
    const std::uint32_t other = port == first_port_ ? first_port_ + 1 : first_port_;
    pending_.push_back({.frame = frame, .receiver = other, .due = sim_time(sent_ns) + delay_});
  }

  /// When the next copy has to be written.
  [[nodiscard]] std::optional<SimTime> next_due() const {
    return pending_.empty() ? std::nullopt : std::optional{pending_.front().due};
  }

  /// A copy that is due by `now`; nothing when there is none.
  [[nodiscard]] std::optional<DueCopy> take_due(SimTime now) {
    if (pending_.empty() || pending_.front().due > now) {
      return std::nullopt;
    }
    const DueCopy copy = pending_.front();
    pending_.pop_front();
    return copy;
  }

 private:
  std::uint32_t first_port_;
  SimClock::duration delay_;
  std::deque<DueCopy> pending_;
};

}  // namespace cuscus::netsim
