#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "common/scenario/names.h"
#include "netsim/phy/standard.h"

namespace cuscus::scenario {
namespace {

TEST_CASE("A scenario's airtimes are those of the emulator, for every rate and length") {
  for (const auto& [name, standard] : kRadioStandardNames) {
    for (const auto& [preamble_name, preamble] : kDsssPreambleNames) {
      Radio radio = default_radio(standard);
      radio.dsss_preamble = preamble;
      const netsim::Standard& emulated =
          netsim::standard_of(name, preamble == DsssPreamble::kShort ? netsim::DsssPreamble::kShort
                                                                     : netsim::DsssPreamble::kLong);
      for (const std::uint32_t rate_kbps : rates_kbps(standard)) {
        for (const std::uint32_t bytes : {14U, 100U, 333U, 1536U, 2332U}) {
          CAPTURE(std::string{name}, std::string{preamble_name}, rate_kbps, bytes);
          const auto there = netsim::airtime(emulated.mode(rate_kbps), bytes);
          // To the nanosecond, as the emulator counts.
          CHECK(std::llround(psdu_airtime_s(radio, bytes, rate_kbps) * 1e9) == there.count());
        }
      }
    }
  }
}

}  // namespace
}  // namespace cuscus::scenario
