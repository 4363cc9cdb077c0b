#include "netsim/mac/rate_control.h"

#include <catch2/catch.hpp>
#include <map>

#include "common/units/decibel.h"
#include "netsim/mac/aarf_rate.h"
#include "netsim/mac/minstrel_rate.h"

namespace cuscus::netsim {
namespace {

constexpr std::uint32_t kPeer = 3;

RateSetting from_rate(std::uint32_t rate_kbps) {
  RateSetting setting = rate_setting(ieee80211g(), ieee80211g().mode(rate_kbps), NistErrorModel{});
  setting.draws = random::CounterStream{1, 2};
  return setting;
}

std::uint32_t rate_of(RateControl& rates, std::uint32_t attempt = 0) {
  return rates.mode({}, kPeer, attempt).rate_kbps;
}

void report(RateControl& rates, bool acknowledged, int times = 1) {
  for (int i = 0; i < times; ++i) {
    rates.report({}, kPeer, rates.mode({}, kPeer, 0), acknowledged);
  }
}

TEST_CASE("a rate control chooses among the rates of its first one's class") {
  CHECK(from_rate(6'000).modes.size() == 8);
  const RateSetting dsss = from_rate(2'000);
  REQUIRE(dsss.modes.size() == 4);
  CHECK(dsss.modes.front()->rate_kbps == 1'000);
  CHECK(dsss.modes.back()->rate_kbps == 11'000);
}

TEST_CASE("the ideal rate is the highest that the peer's SNR carries") {
  IdealRate rates{from_rate(6'000)};
  CHECK(rate_of(rates) == 6'000);  // nothing heard

  rates.heard(kPeer, Decibel{40.0}.ratio());
  CHECK(rate_of(rates) == 54'000);
  // 24 Mb/s fails in 10 % of 1000 B at 13.4 dB; bits in 10^-6 need a little more, 36 Mb/s 3 dB.
  rates.heard(kPeer, Decibel{15.5}.ratio());
  CHECK(rate_of(rates) == 24'000);
  rates.heard(kPeer, Decibel{-10.0}.ratio());
  CHECK(rate_of(rates) == 6'000);
}

TEST_CASE("AARF goes up after ten successes and down after two failures") {
  AarfRate rates{from_rate(6'000)};
  report(rates, true, 9);
  CHECK(rate_of(rates) == 6'000);
  report(rates, true);
  CHECK(rate_of(rates) == 9'000);
  report(rates, true);  // the probe holds

  report(rates, false);
  CHECK(rate_of(rates) == 9'000);
  report(rates, false);
  CHECK(rate_of(rates) == 6'000);
  report(rates, false, 20);
  CHECK(rate_of(rates) == 6'000);  // there is none below
}

TEST_CASE("AARF waits twice as long after each step up that fails, up to sixty successes") {
  AarfRate rates{from_rate(6'000)};
  for (const int needed : {10, 20, 40, 60, 60}) {
    report(rates, true, needed - 1);
    CHECK(rate_of(rates) == 6'000);
    report(rates, true);
    CHECK(rate_of(rates) == 9'000);
    report(rates, false);
    CHECK(rate_of(rates) == 6'000);
  }
}

/// Successes at 6 Mb/s until a step up, which then fails.
int successes_until_failed_step(AarfRate& rates) {
  int successes = 0;
  for (; rate_of(rates) == 6'000; ++successes) {
    report(rates, true);
  }
  report(rates, false);
  return successes;
}

TEST_CASE("AARF is still as patient after a hundred steps up that failed") {
  AarfRate rates{from_rate(6'000)};
  for (int i = 0; i < 100; ++i) {
    successes_until_failed_step(rates);
  }

  CHECK(successes_until_failed_step(rates) == 60);
}

TEST_CASE("AARF goes up after ninety attempts at most where losses break every run of successes") {
  AarfRate rates{from_rate(6'000)};
  for (int i = 0; i < 10; ++i) {  // then its patience is at its greatest
    successes_until_failed_step(rates);
  }

  int attempts = 0;
  for (; rate_of(rates) == 6'000; ++attempts) {
    report(rates, attempts % 10 != 5);
  }

  CHECK(attempts == 90);
}

/// Sends `frames`, 1 ms apart, over a link on which each rate succeeds with its own probability;
/// how often each rate was tried in the last half.
std::map<std::uint32_t, int> tried_rates(MinstrelRate& rates,
                                         const std::map<std::uint32_t, double>& success,
                                         int frames) {
  const random::CounterStream luck{7, 7};
  std::uint64_t draw = 0;
  std::map<std::uint32_t, int> tried;
  for (int frame = 0; frame < frames; ++frame) {
    const SimTime now = sim_time(std::int64_t{1'000'000} * frame);
    for (std::uint32_t attempt = 0; attempt < 7; ++attempt) {
      const Mode& mode = rates.mode(now, kPeer, attempt);
      tried[mode.rate_kbps] += frame > frames / 2 ? 1 : 0;
      const bool acknowledged = luck.uniform(draw++) < success.at(mode.rate_kbps);
      rates.report(now, kPeer, mode, acknowledged);
      if (acknowledged) {
        break;
      }
    }
  }
  return tried;
}

TEST_CASE("Minstrel finds the rate of the highest throughput and goes on trying others") {
  MinstrelRate rates{from_rate(6'000)};
  // 24 Mb/s at 0.95 is worth more than 36 at 0.5 and 54 at 0.05.
  const auto tried = tried_rates(rates,
                                 {{6'000, 1.0},
                                  {9'000, 1.0},
                                  {12'000, 1.0},
                                  {18'000, 1.0},
                                  {24'000, 0.95},
                                  {36'000, 0.5},
                                  {48'000, 0.1},
                                  {54'000, 0.05}},
                                 20'000);
  int all = 0;
  for (const auto& [rate_kbps, count] : tried) {
    all += count;
  }
  CHECK(tried.at(24'000) > 0.7 * all);  // nine frames in ten, of which 5 % are repeated
  CHECK(all - tried.at(24'000) > 0.05 * all);
  CHECK(tried.at(54'000) > 0);
}

TEST_CASE("Minstrel prefers an unreliable rate that is fast enough") {
  MinstrelRate rates{from_rate(6'000)};
  const auto tried = tried_rates(rates,
                                 {{6'000, 1.0},
                                  {9'000, 1.0},
                                  {12'000, 1.0},
                                  {18'000, 1.0},
                                  {24'000, 1.0},
                                  {36'000, 1.0},
                                  {48'000, 1.0},
                                  {54'000, 0.95}},
                                 20'000);
  CHECK(tried.at(54'000) > 10'000 * 0.7);
}

TEST_CASE("Minstrel comes to the lowest rate before the retry limit ends a frame") {
  // At one half no rate is settled: as many attempts as fit into 6 ms would be 28 at 54 Mb/s.
  const double success = GENERATE(0.0, 0.5, 1.0);
  const std::uint32_t limit = GENERATE(4U, 7U, 20U);
  RateSetting setting = from_rate(54'000);
  setting.attempts = limit;
  MinstrelRate rates{setting};
  tried_rates(rates,
              {{6'000, 1.0},
               {9'000, success},
               {12'000, success},
               {18'000, success},
               {24'000, success},
               {36'000, success},
               {48'000, success},
               {54'000, success}},
              2'000);
  CAPTURE(success, limit);
  const SimTime later = sim_time(10'000'000'000);
  for (int frame = 0; frame < 50; ++frame) {
    std::uint32_t last_kbps = 0;
    for (std::uint32_t attempt = 0; attempt < limit; ++attempt) {
      last_kbps = rates.mode(later, kPeer, attempt).rate_kbps;
    }
    CHECK(last_kbps == 6'000);
  }
}

TEST_CASE("an unknown rate control is refused with what exists") {
  CHECK_THROWS_WITH(make_rate_control("onoe", from_rate(6'000)),
                    "rate control 'onoe' is not known; allowed are 'constant', 'ideal', 'aarf', "
                    "'minstrel'");
}

}  // namespace
}  // namespace cuscus::netsim
