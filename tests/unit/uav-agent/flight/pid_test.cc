#include "uav-agent/flight/pid.h"

#include <catch2/catch.hpp>

namespace cuscus::flight {
namespace {

TEST_CASE("a PID's output is the sum of its three terms") {
  Pid pid{{.kp = 2.0, .ki = 0.5, .kd = 3.0, .integral_limit = 10.0, .output_limit = 100.0}};

  double output = 0.0;
  for (int i = 0; i < 400; ++i) {
    output = pid.step(1.5, -0.25, 0.01);
  }

  // kp e + ki e t + kd de/dt after 4 s.
  CHECK(output == Approx(2.0 * 1.5 + 0.5 * 1.5 * 4.0 - 3.0 * 0.25));
}

TEST_CASE("a PID's integral keeps within its limit") {
  Pid pid{{.kp = 0.0, .ki = 1.0, .kd = 0.0, .integral_limit = 0.5, .output_limit = 100.0}};

  for (int i = 0; i < 1000; ++i) {
    pid.step(1.0, 0.0, 0.01);
  }

  CHECK(pid.integral() == 0.5);
  CHECK(pid.step(0.0, 0.0, 0.01) == 0.5);
}

TEST_CASE("a saturated PID does not wind up, and comes back at once") {
  Pid pid{{.kp = 1.0, .ki = 1.0, .kd = 0.0, .integral_limit = 10.0, .output_limit = 1.0}};

  for (int i = 0; i < 1000; ++i) {
    CHECK(pid.step(5.0, 0.0, 0.01) == 1.0);
  }

  CHECK(pid.integral() == 0.0);
  CHECK(pid.step(-0.5, 0.0, 0.01) == Approx(-0.5 - 0.5 * 0.01));
}

TEST_CASE("an integral can be set, within its limit") {
  Pid pid{{.kp = 0.0, .ki = 1.0, .kd = 0.0, .integral_limit = 2.0, .output_limit = 100.0}};

  pid.set_integral(1.5);
  CHECK(pid.integral() == 1.5);
  pid.set_integral(-9.0);
  CHECK(pid.integral() == -2.0);
}

TEST_CASE("nested saturations bound the angle, the rate and the output, in this order") {
  const NestedSatGains gains{.reference_limit_rad = 0.25,
                             .kp_ps = 6.0,
                             .rate_limit_radps = 1.2,
                             .kd_ps = 30.0,
                             .output_limit_radps2 = 60.0};

  SECTION("inside all limits the law is linear") {
    // ((0.1 - 0.02) 6 - 0.3) 30
    CHECK(nested_saturation(0.1, 0.02, 0.3, gains) == Approx(5.4));
  }
  SECTION("the reference is limited before it is compared with the angle") {
    // ((0.25 - 0.1) 6) 30
    CHECK(nested_saturation(9.0, 0.1, 0.0, gains) == Approx(27.0));
    CHECK(nested_saturation(9.0, 0.25, 0.0, gains) == Approx(0.0));
  }
  SECTION("a large angle error asks for the limit of rate, not more") {
    // angle error 0.25 + 0.5: rate wanted 4.5, limited to 1.2
    CHECK(nested_saturation(0.25, -0.5, 0.0, gains) == Approx(36.0));
    CHECK(nested_saturation(0.25, -0.5, 1.2, gains) == Approx(0.0));
  }
  SECTION("the output is limited") {
    CHECK(nested_saturation(0.0, 0.0, -9.0, gains) == 60.0);
    CHECK(nested_saturation(0.0, 0.0, 9.0, gains) == -60.0);
  }
}

}  // namespace
}  // namespace cuscus::flight
