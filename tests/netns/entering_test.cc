// What comes into nodes from outside: visits, and owners without root.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "orchestrator/node/enter_node.h"
#include "orchestrator/node/environment_checks.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/node_identity.h"
#include "tests/support/node_programs.h"
#include "tests/support/root_only.h"
#include "tests/support/test_fleet.h"

namespace cuscus::node {
namespace {

struct VisitResult {
  int exit_code;
  std::string output;
};

/// Visits a node from a process of its own, since a visitor does not come back.
VisitResult visit(const Node& node, const std::vector<std::string>& arguments,
                  const std::optional<posix::ChildIdentity>& identity = {}) {
  const auto output = test::memory_file();
  // ThreadSanitizer writes out on _exit() what the parent has not yet written.
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t visitor = posix::check("fork", ::fork());
  if (visitor == 0) {
    ::dup2(output.get(), STDOUT_FILENO);
    try {
      ::_exit(enter_node({.init_pid = node.init_pid(),
                          .arguments = arguments,
                          .environment = {"PATH=/usr/bin:/bin"},
                          .identity = identity}));
    } catch (const std::exception&) {
      ::_exit(99);
    }
  }
  int status = -1;
  posix::check("waitpid", ::waitpid(visitor, &status, 0));
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .output = test::content_of(output)};
}

TEST_CASE("a visitor is inside all namespaces of a node, as root or as its user") {
  CUSCUS_ROOT_ONLY();
  const Fleet fleet{test::test_fleet(1, Attachment::kDirect), {}};
  const Node& node = fleet.nodes()[0];

  const auto root = visit(node, {"sh", "-c",
                                 "hostname; ls /sys/class/net; echo /proc/[0-9]*; id -u; "
                                 "tail -n 1 /etc/hosts"});
  const auto user =
      visit(node, {"id", "-u"}, posix::ChildIdentity{.uid = node_uid(0), .gid = node_uid(0)});

  CHECK(root.output == "uav0\nlo\nmon0\nwlan0\n/proc/1 /proc/2\n0\n10.0.0.1\tuav0\n");
  CHECK(user.output == std::to_string(node_uid(0)) + "\n");
}

TEST_CASE("a visitor's exit code is the program's, or tells the signal") {
  CUSCUS_ROOT_ONLY();
  const Fleet fleet{test::test_fleet(1, Attachment::kDirect), {}};

  CHECK(visit(fleet.nodes()[0], {"sh", "-c", "exit 17"}).exit_code == 17);
  CHECK(visit(fleet.nodes()[0], {"sh", "-c", "kill -TERM $$"}).exit_code == 128 + SIGTERM);
  CHECK(visit(fleet.nodes()[0], {"no-such-program"}).exit_code == 99);
}

/// Runs fleet_owner as an ordinary user, with /dev/net/tun of the given mode.
VisitResult run_without_root(const std::string& tun_mode, const std::string& attachment) {
  const auto output = test::memory_file();
  const auto programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  // The host's device keeps its mode: this one is in a mount namespace of the test's own, where an
  // ordinary user also reaches the programs, wherever they were built.
  const std::string script =
      "mount -t tmpfs none /mnt && mkdir /mnt/bin && mount --bind \"$0\" /mnt/bin && mknod -m " +
      tun_mode +
      " /mnt/tun c 10 200 && mount --bind /mnt/tun /dev/net/tun && "
      "exec setpriv --reuid 65534 --regid 65534 --clear-groups --inh-caps=-all "
      "--bounding-set=-all /mnt/bin/fleet_owner \"$1\" ping";
  auto child = posix::ChildProcess::spawn(
      {.arguments = {"unshare", "--mount", "sh", "-c", script, programs, attachment},
       .environment = {"PATH=/usr/sbin:/usr/bin:/sbin:/bin"},
       .working_directory = "/",
       .output_fd = output.get()});
  const auto status = child.wait();
  return {.exit_code = status.exit_code, .output = test::content_of(output)};
}

TEST_CASE("an ordinary user can fly a fleet in a user namespace") {
  CUSCUS_ROOT_ONLY();
  const std::string attachment = GENERATE("bridge", "direct");

  const auto run = run_without_root("0666", attachment);

  INFO(run.output);
  CHECK(run.exit_code == 0);
  CHECK(run.output.find("uav2 (10.0.0.3)") != std::string::npos);
  CHECK(run.output.find("ping 0\n0\n/proc/1 /proc/2") != std::string::npos);
}

TEST_CASE("an ordinary user who may not open /dev/net/tun is told what to do") {
  CUSCUS_ROOT_ONLY();

  const auto run = run_without_root("0600", "direct");

  CHECK(run.exit_code == 1);
  CHECK(run.output.find("/dev/net/tun cannot be opened") != std::string::npos);
  CHECK(run.output.find("run with sudo") != std::string::npos);
}

TEST_CASE("root on a machine that can fly fails no check of the environment") {
  CUSCUS_ROOT_ONLY();
  const auto checks = check_environment(10);

  CHECK(checks.size() >= 10);
  for (const EnvironmentCheck& check : checks) {
    INFO(check.name << ": " << check.text);
    CHECK(check.result != EnvironmentCheck::Result::kFail);
    CHECK((check.result == EnvironmentCheck::Result::kOk) == check.remedy.empty());
  }
}

TEST_CASE("a fleet too large for the limit of open files fails that check") {
  CUSCUS_ROOT_ONLY();
  constexpr std::size_t kTooMany = 1'000'000'000;

  bool failed = false;
  for (const EnvironmentCheck& check : check_environment(kTooMany)) {
    failed = failed || (check.name == "open files" &&
                        check.result == EnvironmentCheck::Result::kFail && !check.remedy.empty());
  }

  CHECK(failed);
}

}  // namespace
}  // namespace cuscus::node
