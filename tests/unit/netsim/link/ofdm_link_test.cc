#include "netsim/link/ofdm_link.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "netsim/link/link_curve.h"

namespace cuscus::netsim {
namespace {

TEST_CASE("every frame arrives without noise and none arrives in much of it") {
  for (const Mode& mode : standard_of("802.11a").modes) {
    CAPTURE(mode.rate_kbps);
    const OfdmLink link{mode.modulation, mode.code_rate, 1};
    for (std::uint64_t frame = 0; frame < 5; ++frame) {
      CHECK(link.survives(frame, kShortFrameBits, Decibel{60.0}));
      CHECK_FALSE(link.survives(frame, kShortFrameBits, Decibel{-10.0}));
    }
  }
}

TEST_CASE("a frame's fate depends on its number and the seed alone") {
  const OfdmLink link{Modulation::kQpsk, CodeRate::kHalf, 7};
  const OfdmLink same{Modulation::kQpsk, CodeRate::kHalf, 7};
  const OfdmLink other{Modulation::kQpsk, CodeRate::kHalf, 8};
  int survivors = 0;
  int differ = 0;
  for (std::uint64_t frame = 200; frame-- > 0;) {
    const bool survived = link.survives(frame, 800, Decibel{2.5});
    REQUIRE(same.survives(frame, 800, Decibel{2.5}) == survived);
    survivors += survived ? 1 : 0;
    differ += other.survives(frame, 800, Decibel{2.5}) != survived ? 1 : 0;
  }
  CHECK(survivors > 10);
  CHECK(survivors < 190);
  CHECK(differ > 10);
}

TEST_CASE("a point of a curve is the share of frames lost, spread over their bits") {
  const LinkPoint point{.snr_db = 0.0, .frame_bits = 1000, .frames = 400, .failures = 100};

  CHECK(std::pow(1.0 - point.bit_failure(), 1000.0) == Approx(0.75));
}

}  // namespace
}  // namespace cuscus::netsim
