#pragma once

#include <array>
#include <optional>
#include <utility>

#include "netsim/mac/csma.h"

namespace cuscus::netsim {

/// A station between a PHY and an event queue that a test plays: remembers what the station asks,
/// and does it on request.
class CsmaStation : public MacHost {
 public:
  using Access = AccessProfile (*)(const MacParameters& parameters);

  CsmaStation(std::uint32_t station, MacParameters parameters, Access access,
              random::CounterStream backoffs)
      : mac{std::move(parameters)}, node{station}, csma{station, mac,      *this,
                                                        rates,   backoffs, access(mac)} {}

  void transmit(std::uint32_t /*node*/, const MacFrame& frame, const Mode& mode,
                std::uint32_t psdu_bytes) override {
    sent = frame;
    sent_bytes = psdu_bytes;
    ends = now + airtime(mode, psdu_bytes);
    ++transmissions;
  }
  void set_timer(std::uint32_t /*node*/, MacTimer timer, SimTime time) override {
    timers.at(static_cast<std::size_t>(timer)) = time;
  }
  void cancel_timer(std::uint32_t /*node*/, MacTimer timer) override {
    timers.at(static_cast<std::size_t>(timer)).reset();
  }
  void finished(std::uint32_t /*node*/, const Msdu& msdu, SendOutcome result,
                std::uint32_t count) override {
    outcome = result;
    attempts = count;
    finished_frame = msdu.frame;
  }

  [[nodiscard]] std::optional<SimTime> timer(MacTimer which) const {
    return timers.at(static_cast<std::size_t>(which));
  }
  void fire(MacTimer which) {
    now = timer(which).value();
    timers.at(static_cast<std::size_t>(which)).reset();
    csma.timer(now, which);
  }
  void end_transmission() {
    now = ends;
    csma.transmission_ended(now);
  }
  void enqueue(SimTime time, std::int32_t destination, std::uint32_t frame = 1,
               std::uint8_t priority = 0) {
    now = time;
    csma.enqueue(now, {.frame = frame,
                       .destination = destination,
                       .psdu_bytes = 100,
                       .priority = priority,
                       .queued_at = now});
  }
  void busy(SimTime from, SimTime to) {
    csma.medium_busy(from);
    csma.medium_idle(to);
  }
  void receive_ack() {
    now = ends + mac.sifs + airtime(mac.answer_to(*mac.data_mode), kAckBytes);
    csma.medium_busy(now - std::chrono::microseconds{46});
    csma.reception_started(now - std::chrono::microseconds{30});
    csma.received(
        now,
        {.kind = MacFrame::Kind::kAck, .sender = 1, .receiver = static_cast<std::int32_t>(node)},
        mac.answer_to(*mac.data_mode));
    csma.medium_idle(now);
  }

  MacParameters mac;
  std::uint32_t node;
  ConstantRate rates{{.modes = {}, .required_snr = {}, .first = mac.data_mode}};
  Csma csma;
  SimTime now{};
  SimTime ends{};
  MacFrame sent{};
  std::uint32_t sent_bytes{0};
  int transmissions{0};
  std::array<std::optional<SimTime>, kMacTimers> timers{};
  std::optional<SendOutcome> outcome;
  std::uint32_t attempts{0};
  std::uint32_t finished_frame{0};
};

}  // namespace cuscus::netsim
