#include "world/actuation/command_gate.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <limits>

namespace cuscus::world {
namespace {

using namespace std::chrono_literals;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SimTime at(SimClock::duration since_start) { return SimTime{since_start}; }

shm::ActuatorCommand command(std::uint64_t sequence, double motors) {
  return {.sim_time_ns = 0, .sequence = sequence, .motors = {motors, motors, motors, motors}};
}

TEST_CASE("motors stand still before the first command, without counting a timeout") {
  CommandGate gate{100ms};

  gate.expire(at(10s));

  CHECK(gate.motors() == CommandGate::Motors{});
  CHECK_FALSE(gate.driven());
  CHECK(gate.tally().timeouts == 0);
}

TEST_CASE("a command in range drives the motors; 0 and 1 are in range") {
  CommandGate gate{100ms};

  gate.offer(at(1ms), command(1, 0.0));
  gate.offer(at(2ms), command(2, 1.0));

  CHECK(gate.tally().accepted == 2);
  CHECK(gate.driven());
  CHECK(gate.motors() == CommandGate::Motors{1.0, 1.0, 1.0, 1.0});
}

TEST_CASE("a command that is not finite or out of range leaves the one before it in force") {
  struct Case {
    double motor;
    bool finite;
  };
  const auto [motor, finite] =
      GENERATE(Case{kNan, false}, Case{kInfinity, false}, Case{-kInfinity, false},
               Case{-1e-9, true}, Case{1.0 + 1e-9, true}, Case{1e300, true});
  const std::size_t index = GENERATE(0U, 3U, 7U);
  CAPTURE(motor, index);
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(1, 0.5));
  shm::ActuatorCommand bad = command(2, 0.6);
  bad.motors.at(index) = motor;

  gate.offer(at(1ms), bad);

  CHECK(gate.motors() == CommandGate::Motors{0.5, 0.5, 0.5, 0.5});
  CHECK(gate.tally().accepted == 1);
  CHECK(gate.tally().rejected_not_finite == (finite ? 0U : 1U));
  CHECK(gate.tally().rejected_out_of_range == (finite ? 1U : 0U));
}

TEST_CASE("a command that cannot be read as a whole is counted and changes nothing") {
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(1, 0.5));

  gate.offer(at(1ms), std::nullopt);

  CHECK(gate.tally().rejected_torn == 1);
  CHECK(gate.motors() == CommandGate::Motors{0.5, 0.5, 0.5, 0.5});
}

TEST_CASE("a repeated sequence number is no new command") {
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(0, 0.3));
  CHECK_FALSE(gate.driven());

  gate.offer(at(0ms), command(4, 0.5));
  gate.offer(at(90ms), command(4, 0.7));
  gate.expire(at(100ms));

  CHECK(gate.tally().accepted == 1);
  CHECK(gate.tally().timeouts == 1);
}

TEST_CASE("an agent that starts again may count from 1 again") {
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(1000, 0.5));

  gate.offer(at(1ms), command(1, 0.6));

  CHECK(gate.tally().accepted == 2);
  CHECK(gate.motors()[0] == 0.6);
}

TEST_CASE("motors stop once when commands stay away, and run again with the next one") {
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(1, 0.5));

  gate.expire(at(99ms));
  CHECK(gate.driven());
  gate.expire(at(100ms));
  gate.expire(at(101ms));

  CHECK_FALSE(gate.driven());
  CHECK(gate.motors() == CommandGate::Motors{});
  CHECK(gate.tally().timeouts == 1);

  gate.offer(at(200ms), command(2, 0.4));
  CHECK(gate.driven());
  CHECK(gate.motors()[0] == 0.4);
}

TEST_CASE("rejected commands do not keep the motors running") {
  CommandGate gate{100ms};
  gate.offer(at(0ms), command(1, 0.5));

  for (std::uint64_t i = 1; i <= 10; ++i) {
    gate.offer(at(i * 10ms), command(i + 1, kNan));
    gate.expire(at(i * 10ms));
  }

  CHECK(gate.tally().rejected_not_finite == 10);
  CHECK(gate.tally().timeouts == 1);
  CHECK_FALSE(gate.driven());
}

}  // namespace
}  // namespace cuscus::world
