#pragma once

#include <cstdint>

#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// How frames of one category contend for the medium.
struct AccessParameters {
  Duration aifs{};  ///< For so long the medium must have been idle; of the DCF: DIFS.
  std::uint32_t cw_min{};
  std::uint32_t cw_max{};
};

/// Backoff of one category (IEEE Std 802.11-2016, 10.3.4.3): slots that are counted down while the
/// medium is idle, from AIFS after it became so, and are kept while it is busy. A slot counts when
/// it is over.
class Backoff {
 public:
  Backoff(const AccessParameters& access, Duration slot)
      : access_{access}, slot_{slot}, window_{access.cw_min} {}

  /// Access when the medium has stayed idle for AIFS from now on, without any slots.
  void begin_at_once(SimTime now);
  /// `slots` is a draw from 0 ... window().
  void begin(SimTime now, std::uint32_t slots);
  void end();
  /// Nothing is counted before `now`.
  void hold(SimTime now);
  /// Charges the idle time up to `now`. Without a frame to send a backoff that runs out ends.
  void count_down(SimTime now, SimTime idle_since, bool frame_waits);

  void widen();  ///< After a failure.
  void reset_window() { window_ = access_.cw_min; }

  [[nodiscard]] bool contending() const { return contending_; }
  /// No slots were drawn: an interruption has to draw them.
  [[nodiscard]] bool at_once() const { return contending_ && at_once_; }
  [[nodiscard]] std::uint32_t window() const { return window_; }
  [[nodiscard]] SimTime access_time(SimTime idle_since) const;

 private:
  [[nodiscard]] SimTime countdown_begins(SimTime idle_since) const;

  AccessParameters access_;
  Duration slot_;
  std::uint32_t window_;
  bool contending_{false};
  bool at_once_{false};
  std::uint32_t slots_{0};
  SimTime not_before_{};
};

}  // namespace cuscus::netsim
