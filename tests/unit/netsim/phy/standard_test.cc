#include "netsim/phy/standard.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

TEST_CASE("airtimes of 802.11g are those of the standard's formula at every rate") {
  struct Row {
    std::uint32_t rate_kbps;
    int ack_us;    // of the control answer's rate, 14 B
    int short_us;  // 100 B
    int long_us;   // 1536 B
  };
  // TXTIME = 20 + 4 ceil((16 + 8 n + 6) / N_DBPS) + 6, worked by hand per rate.
  const auto row =
      GENERATE(Row{6'000, 50, 166, 2078}, Row{9'000, 50, 118, 1394}, Row{12'000, 38, 98, 1054},
               Row{18'000, 38, 74, 710}, Row{24'000, 34, 62, 542}, Row{36'000, 34, 50, 370},
               Row{48'000, 34, 46, 286}, Row{54'000, 34, 42, 254});
  const std::array<std::uint32_t, 3> basic{6'000, 12'000, 24'000};
  const Mode& mode = ieee80211g().mode(row.rate_kbps);
  CAPTURE(row.rate_kbps);

  CHECK(airtime(mode, 100) == microseconds{row.short_us});
  CHECK(airtime(mode, 1536) == microseconds{row.long_us});
  CHECK(airtime(control_answer(ieee80211g(), mode, basic), kAckBytes) == microseconds{row.ack_us});
}

TEST_CASE("without a basic rate that fits, the highest mandatory rate below answers") {
  const std::array<std::uint32_t, 1> only_54{54'000};

  CHECK(control_answer(ieee80211g(), ieee80211g().mode(18'000), only_54).rate_kbps == 12'000);
  CHECK(control_answer(ieee80211g(), ieee80211g().mode(9'000), {}).rate_kbps == 6'000);
  CHECK(control_answer(ieee80211g(), ieee80211g().mode(54'000), {}).rate_kbps == 24'000);
}

TEST_CASE("airtimes of 802.11a lack the signal extension") {
  const Standard& standard = standard_of("802.11a");

  // 20 + 4 ceil((22 + 8 n) / N_DBPS)
  CHECK(airtime(standard.mode(6'000), 100) == microseconds{160});
  CHECK(airtime(standard.mode(54'000), 1536) == microseconds{248});
}

TEST_CASE("airtimes of 802.11p are those of 802.11a at half the clock") {
  const Standard& standard = standard_of("802.11p");
  // 40 + 8 ceil((22 + 8 n) / N_DBPS), 164 B, worked by hand.
  const auto [rate_kbps, expected_us] = GENERATE(table<std::uint32_t, int>(
      {{3'000, 488}, {4'500, 344}, {6'000, 264}, {9'000, 192}, {12'000, 152}, {27'000, 96}}));
  CAPTURE(rate_kbps);

  CHECK(airtime(standard.mode(rate_kbps), 164) == microseconds{expected_us});
  const Mode& same = standard_of("802.11a").mode(2 * rate_kbps);
  CHECK(airtime(standard.mode(rate_kbps), 1000) == 2 * airtime(same, 1000));
}

TEST_CASE("airtimes of DSSS and CCK are preamble, PLCP header and payload in whole microseconds") {
  struct Row {
    std::uint32_t rate_kbps;
    int long_us;  // 164 B
    int short_us;
    int ack_us;  // with the long preamble, 14 B
  };
  // 192 or 96 us, and ceil(8 n / R).
  const auto row = GENERATE(Row{1'000, 1504, 1504, 304}, Row{2'000, 848, 752, 248},
                            Row{5'500, 431, 335, 213}, Row{11'000, 312, 216, 203});
  const auto* const name = GENERATE("802.11b", "802.11g");
  CAPTURE(row.rate_kbps, name);
  const Mode& with_long = standard_of(name).mode(row.rate_kbps);

  CHECK(airtime(with_long, 164) == microseconds{row.long_us});
  CHECK(airtime(with_long, kAckBytes) == microseconds{row.ack_us});
  CHECK(airtime(standard_of(name, DsssPreamble::kShort).mode(row.rate_kbps), 164) ==
        microseconds{row.short_us});
}

TEST_CASE("control answers stay in the class of the frame unless the rule says otherwise") {
  const Standard& standard = ieee80211g();
  const std::array<std::uint32_t, 4> mixed{1'000, 2'000, 11'000, 24'000};
  const auto answer = [&](std::uint32_t rate_kbps, ControlAnswerRule rule) {
    return control_answer(standard, standard.mode(rate_kbps), mixed, rule).rate_kbps;
  };

  CHECK(answer(54'000, ControlAnswerRule::kSameClass) == 24'000);
  CHECK(answer(18'000, ControlAnswerRule::kSameClass) == 12'000);  // highest mandatory
  CHECK(answer(18'000, ControlAnswerRule::kAnyClass) == 11'000);
  CHECK(answer(11'000, ControlAnswerRule::kSameClass) == 11'000);
  CHECK(answer(5'500, ControlAnswerRule::kAnyClass) == 2'000);
}

TEST_CASE("the modes of a standard go upwards") {
  for (const auto* const name : {"802.11a", "802.11b", "802.11g", "802.11p"}) {
    const auto modes = standard_of(name).modes;
    CHECK(std::is_sorted(modes.begin(), modes.end(),
                         [](const Mode& a, const Mode& b) { return a.rate_kbps < b.rate_kbps; }));
  }
}

TEST_CASE("a rate or a standard that does not exist is refused with what does") {
  CHECK_THROWS_WITH(ieee80211g().mode(7'000),
                    "802.11g has no rate of 7000 kb/s; allowed are 1000, 2000, 5500, 6000, 9000, "
                    "11000, 12000, 18000, 24000, 36000, 48000, 54000");
  CHECK_THROWS_WITH(standard_of("802.11zz"),
                    "radio standard '802.11zz' is not known; allowed are '802.11a', '802.11b', "
                    "'802.11g', '802.11p'");
}

TEST_CASE("an Ethernet frame grows by 22 B on the air") {
  // 1500 B of IP: 1514 B of Ethernet, 1536 B of PSDU.
  CHECK(psdu_bytes_of_ethernet(1514) == 1536);
}

}  // namespace
}  // namespace cuscus::netsim
