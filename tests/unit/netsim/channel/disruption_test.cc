#include "netsim/channel/disruption.h"

#include <catch2/catch.hpp>
#include <chrono>

namespace cuscus::netsim {
namespace {

using std::chrono::milliseconds;

SimTime at_ms(std::int64_t ms) { return SimTime{} + milliseconds{ms}; }

TEST_CASE("a fixed stretch begins at its offset in every interval and may reach into the next") {
  const Disruption plain{
      {.fraction = 0.4, .interval = milliseconds{1000}, .offset = milliseconds{300}}};
  const Disruption wrapped{
      {.fraction = 0.4, .interval = milliseconds{1000}, .offset = milliseconds{900}}};

  for (const std::int64_t interval_ms : {0, 1000, 7000}) {
    CHECK_FALSE(plain.overlaps(at_ms(interval_ms), at_ms(interval_ms + 299)));
    CHECK(plain.overlaps(at_ms(interval_ms), at_ms(interval_ms + 300)));
    CHECK(plain.overlaps(at_ms(interval_ms + 699), at_ms(interval_ms + 800)));
    CHECK_FALSE(plain.overlaps(at_ms(interval_ms + 700), at_ms(interval_ms + 800)));
    CHECK(wrapped.overlaps(at_ms(interval_ms + 299), at_ms(interval_ms + 300)));
    CHECK_FALSE(wrapped.overlaps(at_ms(interval_ms + 300), at_ms(interval_ms + 899)));
    CHECK(wrapped.overlaps(at_ms(interval_ms + 900), at_ms(interval_ms + 901)));
  }
  CHECK(plain.overlaps(at_ms(700), at_ms(1300)));
}

TEST_CASE("a stretch at random lies within its interval, at another place by interval and seed") {
  const DisruptionParameters parameters{
      .fraction = 0.4, .interval = milliseconds{1000}, .phase = DisruptionPhase::kRandom};
  DisruptionParameters other = parameters;
  other.seed = 2;
  const auto jammed_ms = [](const DisruptionParameters& p, std::int64_t interval) {
    const Disruption disruption{p};
    std::pair<std::int64_t, std::int64_t> count_and_first{0, -1};
    for (std::int64_t ms = 0; ms < 1000; ++ms) {
      if (disruption.overlaps(at_ms(1000 * interval + ms), at_ms(1000 * interval + ms))) {
        count_and_first.second = count_and_first.first++ == 0 ? ms : count_and_first.second;
      }
    }
    return count_and_first;
  };

  for (std::int64_t interval = 0; interval < 20; ++interval) {
    CHECK(jammed_ms(parameters, interval).first == 400);
  }
  CHECK(jammed_ms(parameters, 3).second != jammed_ms(parameters, 4).second);
  CHECK(jammed_ms(parameters, 3).second != jammed_ms(other, 3).second);
  CHECK(jammed_ms(parameters, 3).second == jammed_ms(parameters, 3).second);
}

TEST_CASE("what cannot be disrupted is refused") {
  CHECK_THROWS_WITH(Disruption{{.fraction = 1.5}}, Catch::Contains("at most 1"));
  CHECK_THROWS_WITH((Disruption{{.fraction = 0.5, .interval = milliseconds{0}}}),
                    Catch::Contains("at least 1 ms"));
  CHECK_THROWS_WITH((Disruption{{.fraction = 0.5, .offset = milliseconds{1001}}}),
                    Catch::Contains("within the interval"));
}

}  // namespace
}  // namespace cuscus::netsim
