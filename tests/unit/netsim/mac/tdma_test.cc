#include "netsim/mac/tdma.h"

#include <array>
#include <catch2/catch.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::uint32_t kOwner = 1;
constexpr std::uint32_t kPsdu_bytes = 128;  // 202 us at 6 Mb/s, 802.11g

/// Slots of 1 ms: node 0, node 1 (the one tested), nobody, node 1.
MacParameters tdma_parameters() {
  constexpr std::array<std::uint32_t, 1> kBasicRate{6'000};
  auto p = MacParameters::from(ieee80211g(), microseconds{20}, 6'000, 6'000, kBasicRate);
  p.queue_frames = 3;
  p.queue_lifetime = milliseconds{20};
  p.tdma = {.slot = milliseconds{1}, .guard = microseconds{10}, .frame = {0, 1, kNobody, 1}};
  return p;
}

SimTime at_us(std::int64_t us) { return SimTime{} + microseconds{us}; }

/// Stands for PHY and event queue, and plays what the station asks for.
class SlotStation final : public MacHost {
 public:
  explicit SlotStation(MacParameters parameters = tdma_parameters())
      : mac{std::move(parameters)}, tdma{kOwner, mac, *this} {}

  void transmit(std::uint32_t /*node*/, const MacFrame& /*frame*/, const Mode& mode,
                std::uint32_t psdu_bytes) override {
    starts.push_back(now);
    ends = now + airtime(mode, psdu_bytes);
  }
  void set_timer(std::uint32_t /*node*/, MacTimer /*timer*/, SimTime time) override {
    timer = time;
  }
  void cancel_timer(std::uint32_t /*node*/, MacTimer /*timer*/) override { timer.reset(); }
  void finished(std::uint32_t /*node*/, const Msdu& /*msdu*/, SendOutcome outcome,
                std::uint32_t /*attempts*/) override {
    outcomes.push_back(outcome);
    finished_at.push_back(now);
  }

  void enqueue(SimTime time, std::uint32_t psdu_bytes = kPsdu_bytes,
               std::int32_t destination = kGroup) {
    now = time;
    tdma.enqueue(now, {.destination = destination, .psdu_bytes = psdu_bytes, .queued_at = now});
  }
  /// Until nothing is left to do.
  void play() {
    while (ends || timer) {
      if (ends) {
        now = *std::exchange(ends, std::nullopt);
        tdma.transmission_ended(now);
      } else {
        now = *std::exchange(timer, std::nullopt);
        tdma.timer(now, MacTimer::kAccess);
      }
    }
  }

  MacParameters mac;
  Tdma tdma;
  SimTime now{};
  std::optional<SimTime> timer;
  std::optional<SimTime> ends;
  std::vector<SimTime> starts;
  std::vector<SendOutcome> outcomes;
  std::vector<SimTime> finished_at;
};

TEST_CASE("a frame waits for its station's next slot, and goes at once within one") {
  const auto start_of = [](std::int64_t queued_us) {
    SlotStation station;
    station.enqueue(at_us(queued_us));
    station.play();
    return station.starts.at(0);
  };

  CHECK(start_of(0) == at_us(1000));
  CHECK(start_of(999) == at_us(1000));
  CHECK(start_of(1000) == at_us(1000));
  CHECK(start_of(1500) == at_us(1500));
  CHECK(start_of(2000) == at_us(3000));  // slot 2 has no owner
  CHECK(start_of(4000) == at_us(5000));  // the next frame's slot 1
}

TEST_CASE("a frame starts only if its airtime and the guard time fit into what is left") {
  const auto start_of = [](SimTime queued) {
    SlotStation station;
    station.enqueue(queued);
    station.play();
    return station.starts.at(0);
  };

  // 202 us of airtime and 10 us of guard time before the end at 2 ms.
  CHECK(start_of(at_us(1788)) == at_us(1788));
  CHECK(start_of(at_us(1788) + Duration{1}) == at_us(3000));
}

TEST_CASE("frames of one slot follow one another without a gap") {
  auto parameters = tdma_parameters();
  parameters.queue_frames = 100;
  SlotStation station{parameters};
  for (int i = 0; i < 6; ++i) {
    station.enqueue(at_us(0));
  }

  station.play();

  // floor((1000 - 10) / 202) = 4 in slot 1, the rest in slot 3.
  CHECK(station.starts ==
        std::vector{at_us(1000), at_us(1202), at_us(1404), at_us(1606), at_us(3000), at_us(3202)});
  CHECK(station.outcomes == std::vector<SendOutcome>(6, SendOutcome::kSent));
}

TEST_CASE("an individually addressed frame is sent once and asks for no ACK") {
  SlotStation station;
  station.enqueue(at_us(0), kPsdu_bytes, 0);

  station.play();

  CHECK(station.starts.size() == 1);
  CHECK(station.outcomes == std::vector{SendOutcome::kSent});
}

TEST_CASE("a full queue, an old frame and one that fits no slot are dropped with their causes") {
  SlotStation full;
  for (int i = 0; i < 4; ++i) {
    full.enqueue(at_us(0));
  }
  CHECK(full.outcomes == std::vector{SendOutcome::kQueueFull});

  // 26 us and 4 us per 24 bit of 8 L + 22: 241 symbols (720 B) take exactly the 990 us that the
  // guard time leaves, 242 do not fit.
  SlotStation long_frame;
  long_frame.enqueue(at_us(0), 720);
  CHECK(long_frame.outcomes.empty());
  long_frame.enqueue(at_us(0), 721);
  CHECK(long_frame.outcomes == std::vector{SendOutcome::kTooLong});

  auto parameters = tdma_parameters();
  parameters.tdma.frame = {0};  // no slot for this station
  SlotStation silent{parameters};
  silent.enqueue(at_us(0));
  silent.play();
  CHECK(silent.starts.empty());
  CHECK(silent.outcomes == std::vector{SendOutcome::kLifetime});
  CHECK(silent.finished_at.at(0) == at_us(20'000) + Duration{1});
}

TEST_CASE("a station takes group frames and those addressed to it") {
  SlotStation station;
  const Mode& mode = *station.mac.data_mode;

  CHECK(station.tdma.received(at_us(0), {.sender = 0, .receiver = kGroup}, mode));
  CHECK(station.tdma.received(at_us(0), {.sender = 0, .receiver = kOwner}, mode));
  CHECK_FALSE(station.tdma.received(at_us(0), {.sender = 0, .receiver = 2}, mode));
}

TEST_CASE("a MAC that does not exist is refused with the names of those that do") {
  CHECK_THROWS_WITH(make_mac("csma", {}),
                    "MAC 'csma' is not known; allowed are 'dcf', 'edca', 'tdma', 'ideal'");
}

TEST_CASE("the MAC 'ideal' is no station's, and says where it is to be had") {
  CHECK_THROWS_WITH(make_mac("ideal", {}), Catch::Contains("IdealAir"));
}

}  // namespace
}  // namespace cuscus::netsim
