#include "netsim/mac/edca.h"

#include <array>
#include <catch2/catch.hpp>
#include <optional>

#include "tests/unit/netsim/mac/csma_station.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::uint32_t kSelf = 4;
// User priorities of the four categories.
constexpr std::uint8_t kBackgroundPriority = 1;
constexpr std::uint8_t kBestEffortPriority = 0;
constexpr std::uint8_t kVideoPriority = 5;
constexpr std::uint8_t kVoicePriority = 6;

MacParameters edca_on(const Standard& standard) {
  constexpr std::array<std::uint32_t, 3> kBasicRates{6'000, 12'000, 24'000};
  auto p = MacParameters::from(standard, standard.slot, 6'000, 6'000, kBasicRates);
  p.short_retry_limit = 3;
  p.long_retry_limit = 3;
  p.queue_frames = 3;
  p.queue_lifetime = milliseconds{500};
  p.edca = default_edca(standard);
  return p;
}

random::CounterStream draws() { return {3, kSelf}; }

class EdcaStation : public CsmaStation {
 public:
  explicit EdcaStation(const MacParameters& parameters = edca_on(ieee80211g()))
      : CsmaStation{kSelf, parameters, edca_access, draws()} {}
};

SimTime after_us(std::int64_t us) { return SimTime{} + microseconds{us}; }

/// Slots of a station's draw of that number, from 0 ... window.
int slots_of(std::uint64_t draw, std::uint32_t window) {
  return static_cast<int>(draws().below(draw, window + 1));
}

TEST_CASE("user priorities belong to the categories of the standard") {
  using enum AccessCategory;
  const std::array<AccessCategory, 8> expected{kBestEffort, kBackground, kBackground, kBestEffort,
                                               kVideo,      kVideo,      kVoice,      kVoice};
  for (std::uint8_t priority = 0; priority < 8; ++priority) {
    CHECK(access_category(priority) == expected.at(priority));
  }
}

TEST_CASE("on an idle medium each category waits its own AIFS") {
  // SIFS 10 us and 7, 3, 2, 2 slots of 20 us; of 802.11p SIFS 32 us and 9, 6, 3, 2 slots of 13 us:
  // the AIFS of ETSI EN 302 663, annex C, are 58, 71, 110 and 149 us.
  const auto aifs_us = [](const Standard& standard, std::uint8_t priority) {
    EdcaStation station{edca_on(standard)};
    station.enqueue(after_us(1'000), kGroup, 1, priority);
    return (station.timer(MacTimer::kAccess).value() - after_us(1'000)) / microseconds{1};
  };

  CHECK(aifs_us(ieee80211g(), kBackgroundPriority) == 150);
  CHECK(aifs_us(ieee80211g(), kBestEffortPriority) == 70);
  CHECK(aifs_us(ieee80211g(), kVideoPriority) == 50);
  CHECK(aifs_us(ieee80211g(), kVoicePriority) == 50);
  const Standard& vehicular = standard_of("802.11p");
  CHECK(aifs_us(vehicular, kBackgroundPriority) == 149);
  CHECK(aifs_us(vehicular, kBestEffortPriority) == 110);
  CHECK(aifs_us(vehicular, kVideoPriority) == 71);
  CHECK(aifs_us(vehicular, kVoicePriority) == 58);
}

TEST_CASE("each category draws from its own window and counts from its own AIFS") {
  const auto access_us = [](std::uint8_t priority) {
    EdcaStation station;
    station.csma.medium_busy(after_us(900));
    station.enqueue(after_us(1'000), kGroup, 1, priority);
    station.csma.medium_idle(after_us(1'200));
    return (station.timer(MacTimer::kAccess).value() - after_us(1'200)) / microseconds{1};
  };

  CHECK(access_us(kBestEffortPriority) == 70 + 20 * slots_of(0, 15));
  CHECK(access_us(kVideoPriority) == 50 + 20 * slots_of(0, 7));
  CHECK(access_us(kVoicePriority) == 50 + 20 * slots_of(0, 3));
}

TEST_CASE("EIFS is longer than AIFS by what it is longer than DIFS") {
  EdcaStation station;
  station.csma.medium_busy(after_us(900));
  station.enqueue(after_us(1'000), kGroup, 1, kBestEffortPriority);
  station.csma.reception_failed(after_us(1'200));
  station.csma.medium_idle(after_us(1'200));

  // EIFS 110 us, DIFS 50 us, AIFS 70 us.
  CHECK(station.timer(MacTimer::kAccess) ==
        after_us(1'200 + 110 - 50 + 70) + 20 * microseconds{slots_of(0, 15)});
}

TEST_CASE("a QoS header makes data 2 B longer, and tells its category") {
  EdcaStation station;
  station.enqueue(after_us(1'000), 1, 1, kVideoPriority);
  station.fire(MacTimer::kAccess);

  CHECK(station.sent_bytes == 102);  // enqueued with 100 B
  CHECK(station.sent.category == static_cast<std::uint8_t>(AccessCategory::kVideo));
}

/// Two frames of different categories, both ready to go when AIFS[voice] has passed: both windows
/// hold the one value 0.
MacParameters without_backoff() {
  MacParameters p = edca_on(ieee80211g());
  p.edca = {{2, 0, 1}, {2, 0, 1}, {2, 0, 1}, {2, 0, 1}};
  return p;
}

TEST_CASE("of two categories that may send at one time the higher does, the other backs off") {
  EdcaStation station{without_backoff()};
  const std::uint8_t lower = GENERATE(kBackgroundPriority, kBestEffortPriority, kVideoPriority);
  station.enqueue(after_us(1'000), kGroup, 1, lower);
  station.enqueue(after_us(1'000), kGroup, 2, kVoicePriority);

  station.fire(MacTimer::kAccess);

  CHECK(station.now == after_us(1'050));
  CHECK(station.sent.frame == 2);
  const auto category = static_cast<std::size_t>(access_category(lower));
  CHECK(station.csma.contention_window(category) == 1);  // doubled
  CHECK(station.csma.contention_window(static_cast<std::size_t>(AccessCategory::kVoice)) == 0);
  CHECK_FALSE(station.outcome);

  station.end_transmission();
  CHECK(station.finished_frame == 2);
  // The first draw of the loser, of 0 ... 1 slots, counts from AIFS after the winner's frame.
  CHECK(station.timer(MacTimer::kAccess) == station.ends + microseconds{50 + 20 * slots_of(0, 1)});
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.frame == 1);
}

TEST_CASE("internal collisions count as attempts of individually addressed frames only") {
  for (const std::int32_t destination : {1, std::int32_t{kGroup}}) {
    MacParameters parameters = without_backoff();
    parameters.edca = {{2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}};
    EdcaStation station{parameters};
    station.enqueue(after_us(1'000), destination, 1, kVideoPriority);
    for (std::uint32_t urgent = 2; urgent <= 4; ++urgent) {
      station.enqueue(station.now, kGroup, urgent, kVoicePriority);
      station.fire(MacTimer::kAccess);
      CHECK(station.sent.frame == urgent);
      if (urgent == 4 && destination == 1) {  // the third: the retry limit
        CHECK(station.outcome == SendOutcome::kRetryLimit);
        CHECK(station.finished_frame == 1);
        CHECK(station.attempts == 0);
      }
      station.end_transmission();
    }
    CHECK(station.csma.queued(static_cast<std::size_t>(AccessCategory::kVideo)) ==
          (destination == kGroup ? 1 : 0));
  }
}

TEST_CASE("a category waits while another of its station sends and awaits its ACK") {
  EdcaStation station;
  station.enqueue(after_us(1'000), 1, 1, kVoicePriority);
  station.fire(MacTimer::kAccess);
  station.enqueue(station.now + microseconds{10}, kGroup, 2, kBestEffortPriority);
  CHECK_FALSE(station.timer(MacTimer::kAccess));

  station.end_transmission();
  CHECK_FALSE(station.timer(MacTimer::kAccess));
  SECTION("the ACK comes: AIFS after it, with the backoff drawn when the frame was queued") {
    station.receive_ack();
    const auto best_effort = station.now + microseconds{70 + 20 * slots_of(0, 15)};
    CHECK(station.timer(MacTimer::kAccess) == best_effort);
    CHECK(station.finished_frame == 1);
  }
  SECTION("it does not: what was idle meanwhile is not counted") {
    station.fire(MacTimer::kAnswerTimeout);
    const SimTime timeout = station.now;
    CHECK(timeout == station.ends + microseconds{50});
    // Best effort from AIFS (70 us) after the transmission; the voice frame again at the earliest
    // at the timeout, with a draw from its doubled window.
    const auto best_effort = station.ends + microseconds{70 + 20 * slots_of(0, 15)};
    const auto voice = timeout + microseconds{20 * slots_of(1, 7)};
    CHECK(station.timer(MacTimer::kAccess) == std::min(best_effort, voice));
  }
}

TEST_CASE("a frame that waits for AIFS draws a backoff when another category goes first") {
  EdcaStation station;
  station.enqueue(after_us(1'000), kGroup, 1, kBestEffortPriority);  // at once, after 70 us
  station.enqueue(after_us(1'000), kGroup, 2, kVoicePriority);       // after 50 us
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.frame == 2);
  station.end_transmission();

  CHECK(station.timer(MacTimer::kAccess) == station.ends + microseconds{70 + 20 * slots_of(0, 15)});
}

TEST_CASE("each category has a queue of its own, bounded by itself") {
  EdcaStation station;
  station.csma.medium_busy(after_us(0));
  for (std::uint32_t frame = 1; frame <= 3; ++frame) {
    station.enqueue(after_us(10), kGroup, frame, kBestEffortPriority);
  }
  station.enqueue(after_us(10), kGroup, 4, kVoicePriority);
  CHECK_FALSE(station.outcome);
  station.enqueue(after_us(10), kGroup, 5, kBestEffortPriority);
  CHECK(station.outcome == SendOutcome::kQueueFull);
  CHECK(station.finished_frame == 5);

  CHECK(station.csma.queued(static_cast<std::size_t>(AccessCategory::kBestEffort)) == 3);
  CHECK(station.csma.queued(static_cast<std::size_t>(AccessCategory::kVoice)) == 1);
}

TEST_CASE("an expired frame leaves its category, and the others go on") {
  EdcaStation station;
  station.csma.medium_busy(after_us(0));
  station.enqueue(after_us(10), kGroup, 1, kVoicePriority);
  station.enqueue(after_us(600'000), kGroup, 2, kBackgroundPriority);
  station.csma.medium_idle(after_us(600'100));

  station.fire(MacTimer::kAccess);
  CHECK(station.outcome == SendOutcome::kLifetime);
  CHECK(station.finished_frame == 1);
  CHECK(station.transmissions == 0);
  station.fire(MacTimer::kAccess);
  CHECK(station.sent.frame == 2);
}

TEST_CASE("repetitions are told by sender and category") {
  EdcaStation station;
  const Mode& mode = *station.mac.data_mode;
  const MacFrame video{.sender = 1, .receiver = std::int32_t{kSelf}, .sequence = 9, .category = 2};
  MacFrame voice = video;
  voice.category = 3;

  CHECK(station.csma.received(after_us(500), video, mode));
  CHECK(station.csma.received(after_us(2'500), voice, mode));
  CHECK_FALSE(station.csma.received(after_us(4'500), video, mode));
}

}  // namespace
}  // namespace cuscus::netsim
