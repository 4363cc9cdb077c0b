// The whole program, started as the orchestrator starts it.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <memory>
#include <string>

#include "common/posix/check.h"
#include "tests/unit/uav-agent/simulated_run.h"

namespace cuscus::tests {
namespace {

constexpr std::uint64_t kResidentGoal_bytes = 6ULL << 20U;

/// cuscus-agent as a child process that owns the program's end of `run`.
class AgentProcess {
 public:
  explicit AgentProcess(SimulatedRun& run) {
    const posix::UniqueFd end = std::move(run.program).release();
    // Without the flag only for the length of the spawn.
    posix::check("let the child inherit", ::fcntl(end.get(), F_SETFD, 0));
    std::string program = AGENT_PROGRAM;
    std::string number = "CUSCUS_CONTROL_FD=" + std::to_string(end.get());
    std::array<char*, 2> arguments{program.data(), nullptr};
    std::array<char*, 2> environment{number.data(), nullptr};
    const int error = ::posix_spawn(&pid_, program.c_str(), nullptr, nullptr, arguments.data(),
                                    environment.data());
    REQUIRE(error == 0);
  }
  AgentProcess(const AgentProcess&) = delete;
  AgentProcess& operator=(const AgentProcess&) = delete;
  ~AgentProcess() {
    if (pid_ > 0) {
      static_cast<void>(::kill(pid_, SIGKILL));
      static_cast<void>(exit_code());
    }
  }

  int exit_code() {
    int status = 0;
    posix::check("wait for cuscus-agent", ::waitpid(pid_, &status, 0));
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = 0;
};

proto::AgentConfiguration configuration() {
  proto::AgentConfiguration result;
  result.set_node(SimulatedRun::kNode);
  result.set_name("uav2");
  result.set_fleet_size(3);
  result.set_slot(2);
  result.set_control_period_ns(5'000'000);
  result.mutable_circle()->mutable_p_wc_centre_m()->set_z(10.0);
  result.mutable_circle()->set_radius_m(20.0);
  result.mutable_circle()->set_speed_mps(2.5);
  result.set_beacon_period_ns(50'000'000);
  result.set_beacon_address("127.0.0.1");
  result.set_neighbour_timeout_ns(3'000'000'000);
  return result;
}

TEST_CASE("cuscus-agent flies from its start to its stop, reports, and ends with 0") {
  SimulatedRun run;
  run.configure(configuration());
  run.publish_standing(0, 1);
  AgentProcess agent{run};

  CHECK(run.orchestrator.receive().envelope.has_ready());
  run.start();
  CHECK(run.orchestrator.receive().envelope.status().state() == "taking-off");
  run.stop();
  auto last = run.orchestrator.receive();
  while (last.envelope.has_status()) {
    last = run.orchestrator.receive();
  }

  const auto& report = last.envelope.report().agent();
  CHECK(report.loops() > 0);
  CHECK(report.resident_bytes() > 0);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  CHECK(report.resident_bytes() < kResidentGoal_bytes);
#endif
  WARN("resident: " << report.resident_bytes() / 1024 << " KiB, goal "
                    << kResidentGoal_bytes / 1024);
  CHECK(agent.exit_code() == 0);
}

TEST_CASE("cuscus-agent says why it cannot start, and ends with 1") {
  SimulatedRun run;
  auto spoiled = configuration();
  spoiled.mutable_circle()->set_radius_m(-1.0);
  run.configure(spoiled);
  AgentProcess agent{run};

  const auto answer = run.orchestrator.receive();

  CHECK(answer.envelope.failure().text().find("radius") != std::string::npos);
  CHECK(agent.exit_code() == 1);
}

TEST_CASE("cuscus-agent ends when its orchestrator is gone") {
  auto run = std::make_unique<SimulatedRun>();
  run->configure(configuration());
  AgentProcess agent{*run};
  CHECK(run->orchestrator.receive().envelope.has_ready());

  run.reset();

  CHECK(agent.exit_code() == 1);
}

}  // namespace
}  // namespace cuscus::tests
