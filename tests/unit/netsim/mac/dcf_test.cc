#include <array>
#include <catch2/catch.hpp>
#include <optional>

#include "tests/unit/netsim/mac/csma_station.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::uint32_t kNode = 4;
constexpr std::array<std::uint32_t, 3> kBasic{6'000, 12'000, 24'000};

MacParameters parameters() {
  auto p = MacParameters::from(ieee80211g(), microseconds{20}, 6'000, 6'000, kBasic);
  p.short_retry_limit = 7;
  p.long_retry_limit = 4;
  p.queue_frames = 3;
  p.queue_lifetime = milliseconds{500};
  return p;
}

SimTime at(int us) { return SimTime{} + microseconds{us}; }

random::CounterStream backoffs() { return {1, kNode}; }

/// The slots of a station's first backoff, as its stream has them.
int first_backoff() { return static_cast<int>(backoffs().below(0, ieee80211g().cw_min + 1)); }

class Station : public CsmaStation {
 public:
  Station() : CsmaStation{kNode, parameters(), dcf_access, backoffs()} {}

  /// The slots that the access timer has left after `idle_from`, when DIFS has passed.
  [[nodiscard]] int slots_after(SimTime idle_from) const {
    const auto slots = (timer(MacTimer::kAccess).value() - idle_from - mac.difs) / mac.slot;
    return static_cast<int>(slots);
  }
};

TEST_CASE("timing follows from slot, SIFS and the lowest basic rate") {
  const MacParameters p = parameters();

  CHECK(p.difs == microseconds{50});
  CHECK(p.eifs == microseconds{110});
  CHECK(p.answer_timeout(*p.data_mode) == microseconds{50});
}

TEST_CASE("EIFS leaves room for an ACK at 1 Mb/s where anything is sent by DSSS") {
  const auto eifs = [](std::uint32_t data_kbps, std::uint32_t group_kbps,
                       const std::array<std::uint32_t, 1>& basic) {
    return MacParameters::from(ieee80211g(), microseconds{20}, data_kbps, group_kbps, basic).eifs;
  };
  // SIFS, an ACK of 304 us (OFDM: 50 us), DIFS
  CHECK(eifs(54'000, 24'000, {12'000}) == microseconds{10 + 50 + 50});
  CHECK(eifs(54'000, 1'000, {12'000}) == microseconds{10 + 304 + 50});
  CHECK(eifs(11'000, 6'000, {6'000}) == microseconds{10 + 304 + 50});
  CHECK(eifs(54'000, 6'000, {2'000}) == microseconds{10 + 304 + 50});
}

TEST_CASE("a frame that finds an idle medium goes out after DIFS, without backoff") {
  Station station;

  station.enqueue(at(1000), kGroup);

  CHECK(station.timer(MacTimer::kAccess) == at(1050));
}

TEST_CASE("a frame that finds a busy medium draws a backoff, counted from DIFS after it") {
  Station station;
  station.csma.medium_busy(at(900));

  station.enqueue(at(1000), kGroup);
  CHECK_FALSE(station.timer(MacTimer::kAccess));
  station.csma.medium_idle(at(1200));

  CHECK(station.timer(MacTimer::kAccess) == at(1250 + 20 * first_backoff()));
}

TEST_CASE("a medium that becomes busy within DIFS makes an immediate access draw a backoff") {
  Station station;
  station.enqueue(at(1000), kGroup);
  const int slots = first_backoff();
  REQUIRE(slots > 0);  // or access without backoff would look the same

  station.busy(at(1030), at(2000));

  CHECK(station.timer(MacTimer::kAccess) == at(2050 + 20 * slots));
}

TEST_CASE("a backoff is frozen while the medium is busy and goes on after DIFS") {
  Station station;
  station.csma.medium_busy(at(0));
  station.enqueue(at(10), kGroup);
  station.csma.medium_idle(at(100));
  const int slots = station.slots_after(at(100));
  REQUIRE(slots >= 3);  // or the seed has to be another

  // Two slots and a half pass: two are done with.
  station.busy(at(100 + 50 + 50), at(1000));
  CHECK(station.slots_after(at(1000)) == slots - 2);

  // Busy again before DIFS is over: nothing is counted.
  station.busy(at(1049), at(2000));
  CHECK(station.slots_after(at(2000)) == slots - 2);
}

TEST_CASE("after a reception that failed EIFS is waited, until one succeeds") {
  Station station;
  station.csma.medium_busy(at(0));
  station.enqueue(at(10), kGroup);
  station.csma.reception_started(at(20));
  station.csma.reception_failed(at(500));
  station.csma.medium_idle(at(500));
  const int slots = station.slots_after(at(500 + 60));
  CHECK(station.timer(MacTimer::kAccess) == at(500 + 110 + 20 * slots));

  station.csma.medium_busy(at(560));
  station.csma.reception_started(at(576));
  station.csma.received(at(700), {.sender = 1, .receiver = kGroup}, *station.mac.group_mode);
  station.csma.medium_idle(at(700));

  CHECK(station.timer(MacTimer::kAccess) == at(700 + 50 + 20 * slots));
}

TEST_CASE("EIFS begins when the medium is idle after the frame that failed, not before") {
  Station station;
  station.csma.medium_busy(at(0));
  station.enqueue(at(10), kGroup);
  station.csma.reception_failed(at(20));  // its SIGNAL field; the energy stays
  station.csma.medium_idle(at(500));

  CHECK(station.timer(MacTimer::kAccess) == at(500 + 110 + 20 * first_backoff()));
}

TEST_CASE("the duration of a frame for others sets the NAV") {
  Station station;
  station.csma.medium_busy(at(0));
  station.enqueue(at(10), kGroup);
  station.csma.reception_started(at(20));
  station.csma.received(at(500), {.sender = 1, .receiver = 2, .duration = microseconds{60}},
                        *station.mac.data_mode);
  station.csma.medium_idle(at(500));

  CHECK(station.timer(MacTimer::kAccess) == at(500 + 60 + 50 + 20 * first_backoff()));
}

TEST_CASE("a group frame is sent once and followed by a post-backoff") {
  Station station;
  station.enqueue(at(1000), kGroup);
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.duration == microseconds{0});
  station.end_transmission();

  CHECK(station.outcome == SendOutcome::kSent);
  CHECK(station.attempts == 1);

  // The next one within the post-backoff does not go out after DIFS alone (but for a draw of 0).
  station.enqueue(station.now + microseconds{1}, kGroup, 2);
  const int slots = station.slots_after(station.ends);
  CHECK(slots >= 0);
  CHECK(slots <= 15);
  CHECK(station.timer(MacTimer::kAccess) ==
        std::max(station.ends + microseconds{50 + 20 * slots}, station.now));
}

TEST_CASE("a post-backoff that ran out leaves immediate access") {
  Station station;
  station.enqueue(at(1000), kGroup);
  station.fire(MacTimer::kAccess);
  station.end_transmission();

  station.enqueue(at(5000), kGroup, 2);

  CHECK(station.timer(MacTimer::kAccess) == at(5050));
}

TEST_CASE("an acknowledged frame is done at its first attempt") {
  Station station;
  station.enqueue(at(1000), 1);
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.duration == microseconds{60});  // SIFS and an ACK of 50 us
  station.end_transmission();
  CHECK(station.timer(MacTimer::kAnswerTimeout) == station.ends + microseconds{50});

  station.receive_ack();

  CHECK(station.outcome == SendOutcome::kAcknowledged);
  CHECK(station.attempts == 1);
  CHECK_FALSE(station.timer(MacTimer::kAnswerTimeout));
}

TEST_CASE("a missing ACK doubles the window up to its maximum; the seventh drops the frame") {
  Station station;
  station.enqueue(at(1000), 1);
  const std::array<std::uint32_t, 6> windows{31, 63, 127, 255, 511, 1023};
  for (int attempt = 1; attempt <= 7; ++attempt) {
    CHECK(station.transmissions == attempt - 1);
    station.fire(MacTimer::kAccess);
    station.end_transmission();
    CHECK_FALSE(station.timer(MacTimer::kAccess));  // nothing else while an ACK may come
    station.fire(MacTimer::kAnswerTimeout);
    if (attempt < 7) {
      CHECK_FALSE(station.outcome);
      CHECK(station.csma.contention_window() == windows.at(static_cast<std::size_t>(attempt - 1)));
    }
  }

  CHECK(station.outcome == SendOutcome::kRetryLimit);
  CHECK(station.attempts == 7);
  CHECK(station.csma.contention_window() == 15);
  CHECK(station.csma.queued() == 0);
}

TEST_CASE("a retry keeps its sequence number and a new frame gets another") {
  Station station;
  station.enqueue(at(1000), 1);
  station.enqueue(at(1000), 1, 2);
  station.fire(MacTimer::kAccess);
  const std::uint32_t first = station.sent.sequence;
  station.end_transmission();
  station.fire(MacTimer::kAnswerTimeout);
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.sequence == first);
  station.end_transmission();
  station.receive_ack();
  station.fire(MacTimer::kAccess);

  CHECK(station.sent.sequence != first);
}

TEST_CASE("an ACK whose reception has begun by the timeout is waited for") {
  Station station;
  station.enqueue(at(1000), 1);
  station.fire(MacTimer::kAccess);
  station.end_transmission();
  const SimTime ended = station.ends;
  station.csma.medium_busy(ended + microseconds{14});
  station.csma.reception_started(ended + microseconds{30});

  station.fire(MacTimer::kAnswerTimeout);
  CHECK_FALSE(station.outcome);
  CHECK(station.csma.contention_window() == 15);
  station.csma.received(
      ended + microseconds{60},
      {.kind = MacFrame::Kind::kAck, .sender = 1, .receiver = std::int32_t{kNode}},
      station.mac.answer_to(*station.mac.data_mode));

  CHECK(station.outcome == SendOutcome::kAcknowledged);
}

TEST_CASE("data is acknowledged after SIFS, and its repetition is acknowledged but not delivered") {
  Station station;
  const MacFrame data{.sender = 1, .receiver = std::int32_t{kNode}, .sequence = 9};

  CHECK(station.csma.received(at(500), data, *station.mac.data_mode));
  CHECK(station.timer(MacTimer::kResponse) == at(510));
  station.fire(MacTimer::kResponse);
  CHECK(station.sent.kind == MacFrame::Kind::kAck);
  CHECK(station.sent.receiver == 1);
  station.end_transmission();

  CHECK_FALSE(station.csma.received(at(2000), data, *station.mac.data_mode));
  CHECK(station.timer(MacTimer::kResponse) == at(2010));
}

TEST_CASE("a reply goes out DIFS after the ACK of what it answers") {
  Station station;
  const MacFrame data{.sender = 1, .receiver = std::int32_t{kNode}, .sequence = 9};
  station.csma.received(at(500), data, *station.mac.data_mode);
  station.enqueue(at(500), 1);
  CHECK_FALSE(station.timer(MacTimer::kAccess));

  station.fire(MacTimer::kResponse);
  station.end_transmission();

  CHECK(station.timer(MacTimer::kAccess) == at(500 + 10 + 50 + 50));
}

TEST_CASE("a full queue and an expired frame are dropped with their causes") {
  Station station;
  station.csma.medium_busy(at(0));
  station.enqueue(at(10), kGroup, 1);
  station.enqueue(at(11), kGroup, 2);
  station.enqueue(at(600'000), kGroup, 3);
  CHECK_FALSE(station.outcome);
  station.enqueue(at(600'001), kGroup, 4);
  CHECK(station.outcome == SendOutcome::kQueueFull);
  CHECK(station.finished_frame == 4);

  station.csma.medium_idle(at(600'100));
  station.fire(MacTimer::kAccess);

  CHECK(station.outcome == SendOutcome::kLifetime);
  CHECK(station.finished_frame == 2);
  CHECK(station.sent.frame == 3);
}

/// A station that sends RTS before every individually addressed frame.
class AnnouncingStation : public Station {
 public:
  AnnouncingStation() { mac.rts_threshold_bytes = 0; }

  /// The answer to what has just been sent, SIFS after it.
  void receive_answer(MacFrame::Kind kind) {
    now = ends + mac.sifs + airtime(mac.answer_to(*mac.rts_mode), kCtsBytes);
    csma.medium_busy(now - microseconds{46});
    csma.reception_started(now - microseconds{30});
    csma.received(now, {.kind = kind, .sender = 1, .receiver = std::int32_t{kNode}}, *mac.rts_mode);
    csma.medium_idle(now);
  }
};

TEST_CASE("a frame above the threshold is sent SIFS after the CTS to its RTS") {
  AnnouncingStation station;
  station.enqueue(at(1000), 1);
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.kind == MacFrame::Kind::kRts);
  // 3 SIFS, CTS 50 us, 100 B of data 166 us, ACK 50 us
  CHECK(station.sent.duration == microseconds{30 + 50 + 166 + 50});
  station.end_transmission();
  CHECK(station.timer(MacTimer::kAnswerTimeout) == station.ends + microseconds{50});

  station.receive_answer(MacFrame::Kind::kCts);
  CHECK_FALSE(station.timer(MacTimer::kAnswerTimeout));
  CHECK_FALSE(station.timer(MacTimer::kAccess));
  CHECK(station.timer(MacTimer::kResponse) == station.now + microseconds{10});
  station.fire(MacTimer::kResponse);
  CHECK(station.sent.kind == MacFrame::Kind::kData);
  CHECK(station.sent.duration == microseconds{60});
  station.end_transmission();
  station.receive_answer(MacFrame::Kind::kAck);

  CHECK(station.outcome == SendOutcome::kAcknowledged);
}

TEST_CASE("group frames and those below the threshold are sent without RTS") {
  Station station;
  station.mac.rts_threshold_bytes = 100;
  station.enqueue(at(1000), 1);  // of 100 B
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.kind == MacFrame::Kind::kData);

  AnnouncingStation announcing;
  announcing.enqueue(at(1000), kGroup);
  announcing.fire(MacTimer::kAccess);
  CHECK(announcing.sent.kind == MacFrame::Kind::kData);
}

TEST_CASE("missing CTS count against the short retry limit, missing ACKs after RTS the long one") {
  AnnouncingStation without_cts;
  without_cts.enqueue(at(1000), 1);
  for (int attempt = 1; attempt <= 7; ++attempt) {
    REQUIRE_FALSE(without_cts.outcome);
    without_cts.fire(MacTimer::kAccess);
    without_cts.end_transmission();
    without_cts.fire(MacTimer::kAnswerTimeout);
  }
  CHECK(without_cts.outcome == SendOutcome::kRetryLimit);

  AnnouncingStation without_ack;
  without_ack.enqueue(at(1000), 1);
  for (int attempt = 1; attempt <= 4; ++attempt) {
    REQUIRE_FALSE(without_ack.outcome);
    without_ack.fire(MacTimer::kAccess);
    without_ack.end_transmission();
    without_ack.receive_answer(MacFrame::Kind::kCts);
    without_ack.fire(MacTimer::kResponse);
    without_ack.end_transmission();
    without_ack.fire(MacTimer::kAnswerTimeout);
  }
  CHECK(without_ack.outcome == SendOutcome::kRetryLimit);
}

TEST_CASE("an RTS is answered by a CTS for the rest of its time, unless the NAV is set") {
  const MacFrame rts{.kind = MacFrame::Kind::kRts,
                     .sender = 1,
                     .receiver = std::int32_t{kNode},
                     .duration = microseconds{500}};
  Station station;
  CHECK_FALSE(station.csma.received(at(500), rts, *station.mac.rts_mode));
  CHECK(station.timer(MacTimer::kResponse) == at(510));
  station.fire(MacTimer::kResponse);
  CHECK(station.sent.kind == MacFrame::Kind::kCts);
  CHECK(station.sent.duration == microseconds{500 - 10 - 50});

  Station reserved;
  reserved.csma.received(
      at(400),
      {.kind = MacFrame::Kind::kCts, .sender = 2, .receiver = 3, .duration = microseconds{300}},
      *reserved.mac.rts_mode);
  reserved.csma.received(at(500), rts, *reserved.mac.rts_mode);
  CHECK_FALSE(reserved.timer(MacTimer::kResponse));
}

TEST_CASE("the NAV of an RTS is taken back when nothing follows, and stays when something does") {
  const MacFrame rts{
      .kind = MacFrame::Kind::kRts, .sender = 1, .receiver = 2, .duration = microseconds{2'000}};
  const auto access_after = [&](bool data_follows) {
    Station station;
    station.csma.medium_busy(at(0));
    station.enqueue(at(10), kGroup);
    station.csma.reception_started(at(20));
    station.csma.received(at(500), rts, *station.mac.rts_mode);
    station.csma.medium_idle(at(500));
    // 2 SIFS, a CTS of 50 us, aRxPHYStartDelay of 20 us and 2 slots
    CHECK(station.timer(MacTimer::kNavReset) == at(500 + 20 + 50 + 20 + 40));
    if (data_follows) {
      station.csma.medium_busy(at(574));
      station.csma.reception_started(at(590));
      CHECK_FALSE(station.timer(MacTimer::kNavReset));
      station.csma.medium_idle(at(600));
    } else {
      station.fire(MacTimer::kNavReset);
    }
    return station.timer(MacTimer::kAccess).value();
  };

  CHECK(access_after(true) == at(2'500 + 50 + 20 * first_backoff()));
  CHECK(access_after(false) == at(630 + 50 + 20 * first_backoff()));
}

}  // namespace
}  // namespace cuscus::netsim
