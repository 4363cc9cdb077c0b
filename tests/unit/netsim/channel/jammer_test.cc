#include "netsim/channel/jammer.h"

#include <catch2/catch.hpp>
#include <vector>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

SimTime at(std::int64_t us) { return SimTime{} + microseconds{us}; }

TEST_CASE("a jammer pulses with its duty from its start until its stop") {
  const Jammer jammer{{.duty = 0.25,
                       .period = milliseconds{4},
                       .start = milliseconds{10},
                       .stop = microseconds{18'500}}};

  // On in [10, 11) and [14, 15) ms, and in [18, 19) ms up to the stop.
  CHECK_FALSE(jammer.on(at(9'999)));
  CHECK(jammer.on(at(10'000)));
  CHECK_FALSE(jammer.on(at(11'000)));
  CHECK(jammer.on(at(14'000)));
  CHECK(jammer.on(at(18'499)));
  CHECK_FALSE(jammer.on(at(18'500)));
  std::vector<SimTime> switches;
  for (auto next = jammer.next_switch(at(0)); next; next = jammer.next_switch(*next)) {
    switches.push_back(*next);
  }
  CHECK(switches ==
        std::vector{at(10'000), at(11'000), at(14'000), at(15'000), at(18'000), at(18'500)});
}

TEST_CASE("a jammer without breaks never switches after its start") {
  const Jammer jammer{{.duty = 1.0}};

  CHECK(jammer.on(at(0)));
  CHECK(jammer.on(at(123'456'789)));
  CHECK_FALSE(jammer.next_switch(at(0)).has_value());
}

TEST_CASE("a receiver's channel takes the part of a jammer's band that they share") {
  const Band channel{.centre_hz = 2.437e9, .width_hz = 20e6};
  const auto power_of = [&channel](double centre_hz, double width_hz) {
    const Jammer jammer{{.power = {20.0}, .band = {.centre_hz = centre_hz, .width_hz = width_hz}}};
    return jammer.power_in(channel).value;
  };

  CHECK(power_of(2.437e9, 20e6) == 20.0);                              // the same
  CHECK(power_of(2.437e9, 1e3) == 20.0);                               // a tone in it
  CHECK(power_of(2.437e9, 80e6) == Approx(20.0 - 6.02).margin(0.01));  // a quarter
  CHECK(power_of(2.447e9, 20e6) == Approx(20.0 - 3.01).margin(0.01));  // half
  CHECK(power_of(2.457e9, 20e6) < -1e9);                               // beside it
  CHECK(power_of(5.18e9, 20e6) < -1e9);
}

TEST_CASE("a wrong jammer is named, with what is allowed") {
  CHECK_THROWS_WITH((Jammer{{.duty = 0.0}}), "jammer: the duty must be above 0 and at most 1");
  CHECK_THROWS_WITH((Jammer{{.period = microseconds{10}}}),
                    "jammer: the period must be 100 us to 24 h");
  CHECK_THROWS_WITH((Jammer{{.start = milliseconds{2}, .stop = milliseconds{2}}}),
                    "jammer: it must start at 0 s or later, and stop after its start");
  CHECK_THROWS_WITH((Jammer{{.band = {.centre_hz = 2.4e9, .width_hz = 0.0}}}),
                    "jammer: frequency and bandwidth must be above 0 Hz");
}

}  // namespace
}  // namespace cuscus::netsim
