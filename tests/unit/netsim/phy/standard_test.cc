#include "netsim/phy/standard.h"

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

TEST_CASE("a rate or a standard that does not exist is refused with what does") {
  CHECK_THROWS_WITH(ieee80211g().mode(11'000),
                    "802.11g has no rate of 11000 kb/s; allowed are 6000, 9000, 12000, 18000, "
                    "24000, 36000, 48000, 54000");
  CHECK_THROWS_WITH(standard_of("802.11zz"),
                    "radio standard '802.11zz' is not known; allowed are '802.11g'");
}

TEST_CASE("an Ethernet frame grows by 22 B on the air") {
  // 1500 B of IP: 1514 B of Ethernet, 1536 B of PSDU.
  CHECK(psdu_bytes_of_ethernet(1514) == 1536);
}

}  // namespace
}  // namespace cuscus::netsim
