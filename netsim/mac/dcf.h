#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "netsim/mac/mac.h"

namespace cuscus::netsim {

/// One station's distributed coordination function (IEEE Std 802.11-2016, 10.3).
///
/// - A frame that finds an idle medium and no backoff pending goes out when the medium has stayed
/// idle
///   for DIFS since the frame was queued (and DIFS or EIFS since it was last busy) [10.3.4.2].
///   Found busy, or interrupted meanwhile, it draws a backoff. A station's own ACK delays it but is
///   no such interruption: a reply to a frame follows that frame's ACK after DIFS.
/// - Backoff: uniform in 0 ... CW slots, counted down while the medium is idle, frozen while it is
///   busy, resumed after DIFS, or EIFS after a reception that failed, ended early by one that
///   succeeds.
/// - After every transmission a backoff is drawn, whether or not a frame waits (post-backoff).
/// - CW doubles after a missing ACK or CTS and returns to its minimum on success and on giving up.
/// - Every decoded frame for others sets the NAV from its Duration field; that of an RTS after
///   which no frame begins is taken back [10.3.2.4]. A wait for an answer ends at the timeout, or
///   with the reception that had begun by then.
/// - Individually addressed frames above the RTS threshold are announced by RTS; a station whose
///   NAV is set does not answer it.
/// - Receivers acknowledge after SIFS whatever the medium does, and drop repeated frames of a
/// sender.
class Dcf final : public Mac {
 public:
  /// `parameters`, `host` and `rates` must outlive this object.
  Dcf(std::uint32_t node, const MacParameters& parameters, MacHost& host, RateControl& rates,
      random::CounterStream backoffs);

  void enqueue(SimTime now, const Msdu& msdu) override;
  void medium_busy(SimTime now) override;
  void medium_idle(SimTime now) override;
  void reception_started(SimTime now) override;
  void reception_failed(SimTime now) override;
  bool received(SimTime now, const MacFrame& frame, const Mode& mode) override;
  void transmission_ended(SimTime now) override;
  void timer(SimTime now, MacTimer timer) override;

  [[nodiscard]] std::size_t queued() const { return queue_.size(); }
  [[nodiscard]] std::uint32_t contention_window() const { return cw_; }

 private:
  using Kind = MacFrame::Kind;

  [[nodiscard]] SimTime countdown_begins() const;
  [[nodiscard]] SimTime access_time() const;
  void count_down(SimTime now);
  void draw_backoff(SimTime now);
  void schedule_access(SimTime now);
  void access(SimTime now);
  void respond(SimTime now);
  void send_data();
  void respond_after_sifs(SimTime now, const MacFrame& response, const Mode& mode);
  void set_nav(SimTime now, const MacFrame& frame, const Mode& mode);
  [[nodiscard]] bool answers(const MacFrame& frame) const;
  void answer_missing(SimTime now);
  void report_attempt(SimTime now, bool acknowledged);
  void complete(SimTime now, SendOutcome outcome);

  std::uint32_t node_;
  const MacParameters* parameters_;
  MacHost* host_;
  RateControl* rates_;
  random::CounterStream backoffs_;
  std::uint64_t draw_{0};

  std::deque<Msdu> queue_;     ///< The front one is being sent.
  const Mode* mode_;           ///< Of its data.
  std::uint32_t attempts_{0};  ///< RTS or data.
  std::uint32_t short_failures_{0};
  std::uint32_t long_failures_{0};
  std::uint32_t sequence_{0};
  std::uint32_t cw_;

  // Access. `slots_` remain; they are counted from countdown_begins().
  bool contending_{false};  ///< A backoff (or immediate access) is under way.
  bool immediate_{false};   ///< No backoff was drawn: an interruption draws one.
  bool access_set_{false};
  std::uint32_t slots_{0};
  SimTime not_before_{};

  // The medium.
  bool busy_{false};
  std::optional<Kind> sending_;
  SimTime idle_since_{};
  SimTime nav_until_{};
  SimTime nav_without_rts_{};  ///< What the NAV goes back to when an RTS comes to nothing.
  bool eifs_due_{false};       ///< When the medium is idle again.
  SimTime eifs_until_{};       ///< End of an EIFS, less DIFS.

  // The exchange.
  std::optional<Kind> awaited_;  ///< ACK or CTS.
  bool receiving_{false};
  bool response_due_{false};
  MacFrame response_{};  ///< ACK, CTS, or data after a CTS.
  const Mode* response_mode_{nullptr};
  std::vector<std::uint32_t> last_sequence_;  ///< By sender; 0: none.
};

}  // namespace cuscus::netsim
