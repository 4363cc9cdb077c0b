#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "netsim/mac/backoff.h"
#include "netsim/mac/carrier_sense.h"
#include "netsim/mac/mac.h"

namespace cuscus::netsim {

/// Which categories of frames contend for the medium in a station, each by itself.
struct AccessProfile {
  std::vector<AccessParameters> categories;  ///< The one that wins within a station last.
  std::array<std::uint8_t, kPriorities> category_of{};  ///< By user priority.
  std::uint32_t more_header_bytes{0};                   ///< Beyond a non-QoS header.
};

/// The distributed coordination function: one category for all, after DIFS.
[[nodiscard]] AccessProfile dcf_access(const MacParameters& parameters);

/// One station's carrier sense multiple access with collision avoidance (IEEE Std 802.11-2016,
/// 10.3): with one category of frames the DCF, with four EDCA (edca.h).
///
/// - A frame that finds an idle medium and no backoff pending goes out when the medium has stayed
///   idle for DIFS since the frame was queued (and DIFS or EIFS since it was last busy) [10.3.4.2].
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
///   sender.
/// - With several categories each has a queue, a backoff and a CW of its own, and AIFS in place of
///   DIFS. While one has a frame on the air or awaits the answer to it, the others count no slots;
///   for them that frame is a busy medium. Of those whose backoffs end at one time the last sends;
///   the others go on as after a collision on the air [10.22.2.2]: an individually addressed frame
///   has failed once more, and CW doubles.
class Csma final : public Mac {
 public:
  /// `parameters`, `host` and `rates` must outlive this object.
  Csma(std::uint32_t node, const MacParameters& parameters, MacHost& host, RateControl& rates,
       random::CounterStream backoffs, const AccessProfile& profile);
  Csma(const Csma&) = delete;
  Csma& operator=(const Csma&) = delete;
  Csma(Csma&&) = delete;
  Csma& operator=(Csma&&) = delete;
  ~Csma() override = default;

  void enqueue(SimTime now, const Msdu& msdu) override;
  void medium_busy(SimTime now) override;
  void medium_idle(SimTime now) override;
  void reception_started(SimTime now) override;
  void reception_failed(SimTime now) override;
  bool received(SimTime now, const MacFrame& frame, const Mode& mode) override;
  void transmission_ended(SimTime now) override;
  void timer(SimTime now, MacTimer timer) override;

  [[nodiscard]] std::size_t queued(std::size_t category = 0) const {
    return contenders_[category].queue.size();
  }
  [[nodiscard]] std::uint32_t contention_window(std::size_t category = 0) const {
    return contenders_[category].backoff.window();
  }

 private:
  using Kind = MacFrame::Kind;

  /// One category's frames and what it takes to get them on the air.
  struct Contender {
    Contender(const AccessParameters& access, Duration slot) : backoff{access, slot} {}

    std::deque<Msdu> queue;  ///< The front one is the next, or on the air.
    Backoff backoff;
    std::uint32_t attempts{0};  ///< RTS or data.
    std::uint32_t short_failures{0};
    std::uint32_t long_failures{0};
    std::uint32_t sequence{0};
  };

  // Access: csma.cc.
  void count_down(SimTime now);
  void draw_backoff(SimTime now, Contender& contender);
  void schedule_access(SimTime now);
  void access(SimTime now);
  void drop_expired(SimTime now, Contender& contender);
  void collide_internally(SimTime now, Contender& contender);
  void interrupt_all_but(SimTime now, const Contender& winner);
  void back_off_after_failure(SimTime now, Contender& contender);
  void complete(SimTime now, Contender& contender, SendOutcome outcome);

  // The exchange of frames: frame_exchange.cc.
  void begin_exchange(SimTime now, Contender& contender);
  void send_rts();
  void send_data();
  void respond(SimTime now);
  void respond_after_sifs(SimTime now, const MacFrame& response, const Mode& mode);
  void acknowledge(SimTime now, const MacFrame& data, const Mode& mode);
  void clear_to_send(SimTime now, const MacFrame& rts, const Mode& mode);
  void set_nav(SimTime now, const MacFrame& frame, const Mode& mode);
  void answer_received(SimTime now, const MacFrame& frame);
  void answer_missing(SimTime now);
  [[nodiscard]] bool is_new(const MacFrame& data);
  void report_attempt(SimTime now, const Contender& contender, bool acknowledged);

  std::uint32_t node_;
  const MacParameters* parameters_;
  MacHost* host_;
  RateControl* rates_;
  random::CounterStream backoffs_;
  std::uint64_t draw_{0};
  std::array<std::uint8_t, kPriorities> category_of_;
  std::uint32_t more_header_bytes_;

  CarrierSense sense_;
  std::vector<Contender> contenders_;  ///< Their number never changes.
  bool access_set_{false};

  // The exchange.
  Contender* current_{nullptr};  ///< Whose frame is on the air or waits for its answer.
  const Mode* mode_;             ///< Of its data.
  std::optional<Kind> sending_;
  std::optional<Kind> awaited_;  ///< ACK or CTS.
  bool receiving_{false};
  bool response_due_{false};
  MacFrame response_{};  ///< ACK, CTS, or data after a CTS.
  const Mode* response_mode_{nullptr};
  std::vector<std::uint32_t> last_sequence_;  ///< By sender and category; 0: none.
};

}  // namespace cuscus::netsim
