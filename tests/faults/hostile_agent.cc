// hostile-agent: stands in for cuscus-agent and misbehaves as CUSCUS_HOSTILE says, to show that one
// broken flying program harms nobody else.
//
//   nan, out-of-range     motor commands that are no numbers, or far outside 0 ... 1
//   random                random bytes over the whole actuator memory, header and lock included
//   silence               says Ready and nothing more, writes nothing, but obeys Stop
//   exit0, exit3, abort   ends by itself after a second
//   ignore-stop           carries on, whatever it is told
//   babble                random packets on the control socket, as fast as they go
//   flood                 valid heartbeats without end, waiting for room, and does not listen
//   deaf                  never reads its control socket and never says Ready
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <string>

#include "common/ipc/child_session.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/shared_memory.h"
#include "common/random/counter_stream.h"
#include "proto/shm/vehicle_memory.h"

namespace {

using namespace cuscus;  // NOLINT(google-build-using-namespace): a program's own main file

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::int64_t kPeaceful_ns = 1'000'000'000;
constexpr std::uint64_t kSeed = 20260;

class Hostile {
 public:
  Hostile(ipc::ChildSession& session, std::string mode)
      : session_{session}, mode_{std::move(mode)} {
    const proto::Configure configure = session_.await_configuration();
    actuators_ = posix::MemoryMapping::read_write(
        session_.take(proto::Descriptors::KIND_ACTUATOR_MEMORY, configure.agent().node()));
  }

  int run() {
    if (mode_ == "deaf") {
      wait_for_ever();
    }
    session_.ready();
    const auto start_ns = session_.await_start();
    if (!start_ns) {
      return EXIT_SUCCESS;
    }
    posix::sleep_until_monotonic(*start_ns);
    for (std::uint64_t step = 1;; ++step) {
      const std::int64_t now_ns = static_cast<std::int64_t>(step) * kPeriod_ns;
      posix::sleep_until_monotonic(*start_ns + now_ns);
      misbehave(step, now_ns);
      if (mode_ != "ignore-stop" && session_.stop_requested()) {
        return EXIT_SUCCESS;
      }
    }
  }

 private:
  void misbehave(std::uint64_t step, std::int64_t now_ns) {
    if (mode_ == "nan") {
      command(step, now_ns, std::numeric_limits<double>::quiet_NaN());
    } else if (mode_ == "out-of-range") {
      command(step, now_ns, step % 2 == 0 ? 1e300 : -5.0);
    } else if (mode_ == "random") {
      scribble(step);
    } else if (mode_ == "babble") {
      babble(step);
    } else if (mode_ == "flood") {
      flood();
    } else if (now_ns >= kPeaceful_ns) {
      end();
    }
  }

  void command(std::uint64_t sequence, std::int64_t now_ns, double motor) {
    shm::ActuatorMemoryWriter writer{actuators_.writable_bytes()};
    shm::ActuatorCommand command{.sim_time_ns = now_ns, .sequence = sequence, .motors = {}};
    command.motors.fill(motor);
    writer.publish(command);
  }

  void scribble(std::uint64_t step) {
    const random::CounterStream stream{kSeed, step};
    const auto bytes = actuators_.writable_bytes();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::byte>(stream.below(i, 256));
    }
  }

  void babble(std::uint64_t step) {
    const random::CounterStream stream{kSeed, step};
    for (std::uint64_t packet = 0; packet < 20; ++packet) {
      std::string bytes(stream.below(packet, 2000) + 1, '\0');
      std::generate(bytes.begin(), bytes.end(), [&, i = packet * 5000]() mutable {
        return static_cast<char>(stream.below(i++, 256));
      });
      static_cast<void>(
          ::send(session_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
    }
  }

  [[noreturn]] void flood() {
    proto::Envelope envelope;
    envelope.mutable_status()->set_state(std::string(1000, 'x'));
    const std::string bytes = envelope.SerializeAsString();
    for (;;) {
      static_cast<void>(::send(session_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
    }
  }

  void end() const {
    if (mode_ == "exit0") {
      ::_exit(0);
    }
    if (mode_ == "exit3") {
      ::_exit(3);
    }
    if (mode_ == "abort") {
      std::abort();
    }
  }

  [[noreturn]] static void wait_for_ever() {
    for (;;) {
      ::pause();
    }
  }

  ipc::ChildSession& session_;
  std::string mode_;
  posix::MemoryMapping actuators_;
};

}  // namespace

int main() {
  const char* const mode = std::getenv("CUSCUS_HOSTILE");  // NOLINT(concurrency-mt-unsafe)
  if (mode == nullptr) {
    std::cerr << "hostile-agent: CUSCUS_HOSTILE says what to do\n";
    return EXIT_FAILURE;
  }
  try {
    auto session = ipc::ChildSession::from_environment();
    return Hostile{session, mode}.run();
  } catch (const std::exception& error) {
    std::cerr << "hostile-agent: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
