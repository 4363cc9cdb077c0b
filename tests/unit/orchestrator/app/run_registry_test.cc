#include "orchestrator/app/run_registry.h"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "common/posix/check.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;

/// A folder of the test's own.
class Scratch {
 public:
  Scratch() : path_{fs::temp_directory_path() / "cuscus-registry-XXXXXX"} {
    std::string pattern = path_.native();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { fs::remove_all(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

RegisteredRun run_named(const std::string& id) {
  return {.run_id = id,
          .pid = ::getpid(),
          .scenario = "/s.json",
          .results = "/r",
          .started_unix_s = 17,
          .nodes = {{.name = "uav0", .address = "10.42.0.1", .init_pid = 4711}}};
}

TEST_CASE("a run is listed from its entry to its end") {
  const Scratch scratch;
  const RunRegistry registry{scratch.path() / "cuscus"};

  CHECK(registry.runs().empty());
  {
    const auto entry = registry.enter(run_named("one"));
    const auto runs = registry.runs();
    REQUIRE(runs.size() == 1);
    CHECK(runs[0].run_id == "one");
    CHECK(runs[0].nodes.at(0).init_pid == 4711);
    CHECK(registry.sweep().empty());
  }
  CHECK(registry.runs().empty());
  CHECK(fs::is_empty(scratch.path() / "cuscus"));
}

TEST_CASE("what a killed run has left is not listed, and swept") {
  const Scratch scratch;
  const RunRegistry registry{scratch.path() / "cuscus"};
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const auto entry = registry.enter(run_named("dead"));
    ::raise(SIGKILL);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(fs::exists(scratch.path() / "cuscus" / "dead"));

  CHECK(registry.runs().empty());
  CHECK(registry.sweep() == std::vector<std::string>{"dead"});
  CHECK_FALSE(fs::exists(scratch.path() / "cuscus" / "dead"));
}

TEST_CASE("runs that come and go are never taken for dead, nor hindered by who looks") {
  const Scratch scratch;
  const RunRegistry registry{scratch.path() / "cuscus"};
  std::size_t swept = 0;
  std::jthread sweeper{[&](const std::stop_token& over) {
    while (!over.stop_requested()) {
      swept += registry.sweep().size();
    }
  }};
  std::jthread reader{[&](const std::stop_token& over) {
    while (!over.stop_requested()) {
      static_cast<void>(registry.runs());
    }
  }};

  for (int i = 0; i < 100; ++i) {
    const std::string id = std::to_string(i);
    const auto entry = registry.enter(run_named(id));
    entry.publish(run_named(id));
    const auto runs = registry.runs();
    if (runs.size() != 1 || runs[0].run_id != id) {
      FAIL_CHECK("run " << id << " is not listed");
    }
  }
  sweeper.request_stop();
  sweeper.join();

  CHECK(swept == 0);
}

TEST_CASE("a registry behind a symbolic link is refused") {
  const Scratch scratch;
  fs::create_directory(scratch.path() / "elsewhere");
  fs::create_directory(scratch.path() / "elsewhere" / "dead");
  fs::create_directory_symlink(scratch.path() / "elsewhere", scratch.path() / "cuscus");
  const RunRegistry registry{scratch.path() / "cuscus"};

  CHECK_THROWS_AS(registry.runs(), std::system_error);
  CHECK_THROWS_AS(registry.sweep(), std::system_error);
  CHECK_THROWS_AS(registry.enter(run_named("one")), std::system_error);
  CHECK(fs::exists(scratch.path() / "elsewhere" / "dead"));
}

TEST_CASE("a run id is given once") {
  const Scratch scratch;
  const RunRegistry registry{scratch.path() / "cuscus"};
  const auto entry = registry.enter(run_named("one"));

  CHECK_THROWS_AS(registry.enter(run_named("one")), std::system_error);
}

}  // namespace
}  // namespace cuscus::orchestrator
