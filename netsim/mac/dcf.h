#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "common/random/counter_stream.h"
#include "common/units/sim_time.h"
#include "netsim/mac/rate_control.h"
#include "netsim/phy/standard.h"

namespace cuscus::netsim {

/// To whom a frame goes: a node's number, or one of these.
inline constexpr std::int32_t kGroup = -1;   ///< Broadcast or multicast.
inline constexpr std::int32_t kNobody = -2;  ///< An address that no node has.

/// A frame in a station's queue.
struct Msdu {
  std::uint32_t frame{};  ///< The caller's number for it.
  std::int32_t destination{kGroup};
  std::uint32_t psdu_bytes{};
  SimTime queued_at{};
};

/// A frame on the air.
struct MacFrame {
  enum class Kind : std::uint8_t { kData, kAck, kRts, kCts };
  Kind kind{Kind::kData};
  std::uint32_t sender{};
  std::int32_t receiver{kGroup};
  std::uint32_t frame{};     ///< Of the Msdu; data and RTS only.
  std::uint32_t sequence{};  ///< Per sender, kept in retries; data only.
  Duration duration{};  ///< The Duration field: for how long after its end the medium is taken.
};

/// What became of an Msdu at its sender.
enum class SendOutcome : std::uint8_t {
  kSent,          ///< Group frame: put on the air once.
  kAcknowledged,  ///< Individually addressed: confirmed.
  kQueueFull,
  kLifetime,  ///< Waited too long for its first attempt.
  kRetryLimit,
};

/// Of a station; all stations of a run share one.
struct MacParameters {
  Duration slot{};
  Duration sifs{};
  Duration difs{};
  Duration eifs{};
  std::uint32_t cw_min{};
  std::uint32_t cw_max{};
  std::uint32_t short_retry_limit{};    ///< Attempts of RTS, and of data without.
  std::uint32_t long_retry_limit{};     ///< Attempts of data after an RTS.
  std::uint32_t rts_threshold_bytes{};  ///< PSDUs above this are sent after RTS and CTS.
  std::uint32_t queue_frames{};
  Duration queue_lifetime{};  ///< Until the first attempt; after that the retry limit rules.
  const Mode*
      data_mode{};  ///< Of individually addressed frames, until a rate control knows better.
  const Mode* group_mode{};
  const Mode* rts_mode{};
  const Standard* standard{};
  std::vector<const Mode*> answers{};  ///< To frames of each mode of the standard.

  /// DIFS, EIFS and control rates that follow from a standard and its basic rates. RTS is sent at
  /// the rate at which the data would be answered.
  [[nodiscard]] static MacParameters from(const Standard& standard, Duration slot,
                                          std::uint32_t data_rate_kbps,
                                          std::uint32_t group_rate_kbps,
                                          std::span<const std::uint32_t> basic_rates_kbps,
                                          ControlAnswerRule rule = ControlAnswerRule::kSameClass);

  /// At what rate a frame of this mode is answered.
  [[nodiscard]] const Mode& answer_to(const Mode& mode) const {
    return *answers[static_cast<std::size_t>(&mode - standard->modes.data())];
  }
  /// From the end of one's own frame to giving up on the PHY-RXSTART of its answer (10.3.2.9).
  [[nodiscard]] Duration answer_timeout(const Mode& mode) const {
    return sifs + slot + answer_to(mode).format->receive_start_delay;
  }
};

enum class MacTimer : std::uint8_t { kAccess, kResponse, kAnswerTimeout, kNavReset };
inline constexpr std::size_t kMacTimers = 4;

/// What a station asks of the world around it.
class MacHost {
 public:
  virtual ~MacHost() = default;

  /// Puts a frame on the air at once. The host calls transmission_ended() after its airtime.
  virtual void transmit(std::uint32_t node, const MacFrame& frame, const Mode& mode,
                        std::uint32_t psdu_bytes) = 0;
  /// Calls timer() at `time`; replaces the timer of that kind.
  virtual void set_timer(std::uint32_t node, MacTimer timer, SimTime time) = 0;
  virtual void cancel_timer(std::uint32_t node, MacTimer timer) = 0;
  /// The station is done with an Msdu.
  virtual void finished(std::uint32_t node, const Msdu& msdu, SendOutcome outcome,
                        std::uint32_t attempts) = 0;
};

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
///
/// Times must not decrease from call to call.
class Dcf {
 public:
  /// `parameters`, `host` and `rates` must outlive this object.
  Dcf(std::uint32_t node, const MacParameters& parameters, MacHost& host, RateControl& rates,
      random::CounterStream backoffs);

  void enqueue(SimTime now, const Msdu& msdu);

  // What the PHY says.
  void medium_busy(SimTime now);
  void medium_idle(SimTime now);
  void reception_started(SimTime now);  ///< SIGNAL field decoded: PHY-RXSTART.
  void reception_failed(SimTime now);
  /// True when the frame is for this station and is not a repetition.
  bool received(SimTime now, const MacFrame& frame, const Mode& mode);
  void transmission_ended(SimTime now);

  void timer(SimTime now, MacTimer timer);

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
