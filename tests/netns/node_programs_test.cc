#include "tests/support/node_programs.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/node_identity.h"
#include "tests/support/root_only.h"
#include "tests/support/test_fleet.h"

namespace cuscus::node {
namespace {

using test::await_exit;
using test::launch_of;
using test::next_event;
using test::run_in;

constexpr const char* kListProcesses = "echo /proc/[0-9]*";

Fleet lone_node() { return Fleet{test::test_fleet(1, Attachment::kDirect), {}}; }

TEST_CASE("a program has no rights, a uid of its own and no way back") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();

  const auto run = run_in(fleet.nodes()[0], {"grep", "-E", "^(Uid|Gid|Groups|Cap[IPEA]|NoNewPrivs)",
                                             "/proc/self/status"});

  const std::string id = std::to_string(node_uid(0));
  const std::string ids = id + "\t" + id + "\t" + id + "\t" + id + "\n";
  CHECK(run.output == "Uid:\t" + ids + "Gid:\t" + ids +
                          "Groups:\t \n"
                          "CapInh:\t0000000000000000\nCapPrm:\t0000000000000000\n"
                          "CapEff:\t0000000000000000\n"
                          "CapAmb:\t0000000000000000\nNoNewPrivs:\t1\n");
}

TEST_CASE("a program has the capabilities that it is given and no others") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  auto launch = launch_of(1, {"grep", "-E", "^Cap(Prm|Eff)", "/proc/self/status"});
  launch.add_capabilities("cap_net_raw");

  const auto run = run_in(fleet.nodes()[0], launch);

  // CAP_NET_RAW is number 13.
  CHECK(run.output == "CapPrm:\t0000000000002000\nCapEff:\t0000000000002000\n");
}

TEST_CASE("a program that only root can reach runs, and has no rights for it") {
  CUSCUS_ROOT_ONLY();
  const auto folder =
      std::filesystem::temp_directory_path() / ("cuscus-closed-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  const auto program = folder / "grep";
  std::filesystem::copy_file("/usr/bin/grep", program);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  Fleet fleet = lone_node();

  const auto run = run_in(fleet.nodes()[0],
                          {program.native(), "-E", "^(Uid|CapPrm|CapEff)", "/proc/self/status"});
  const auto look = run_in(fleet.nodes()[0], {"ls", folder.native()});
  std::filesystem::remove_all(folder);

  const std::string id = std::to_string(node_uid(0));
  CHECK(run.exited.error().empty());
  CHECK(run.output == "Uid:\t" + id + "\t" + id + "\t" + id + "\t" + id +
                          "\nCapPrm:\t0000000000000000\nCapEff:\t0000000000000000\n");
  CHECK(look.exited.exit_code() != 0);
}

TEST_CASE("even root in a node has no rights there") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  auto launch = launch_of(1, {"mount", "-t", "tmpfs", "none", "/mnt"});
  launch.set_uid(0);
  launch.set_gid(0);

  const auto run = run_in(fleet.nodes()[0], launch);

  CHECK(run.exited.exit_code() != 0);
}

TEST_CASE("a program sees the processes of its node only") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();

  const auto run = run_in(fleet.nodes()[0], {"sh", "-c", kListProcesses});

  CHECK(run.output == "/proc/1 /proc/2\n");
}

TEST_CASE("a node has its own /run, /dev/shm and names, and cannot write to /sys") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();

  const auto run = run_in(fleet.nodes()[0], {"sh", "-c",
                                             "ls -A /run /dev/shm; tail -n 1 /etc/hosts; "
                                             "touch /sys/x 2>/dev/null || echo read-only"});

  CHECK(run.output == "/dev/shm:\n\n/run:\nhosts\n10.0.0.1\tuav0\nread-only\n");
}

TEST_CASE("a fleet without names leaves every node the host's") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test::test_fleet(1, Attachment::kDirect), {.hosts = false}};

  const auto run = run_in(fleet.nodes()[0], {"cat", "/etc/hosts"});

  std::ifstream file{"/etc/hosts"};
  CHECK(run.output == std::string{std::istreambuf_iterator<char>{file}, {}});
}

TEST_CASE("ends of programs are reported with exit code or signal") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  Node& node = fleet.nodes()[0];

  CHECK(run_in(node, {"sh", "-c", "exit 42"}).exited.exit_code() == 42);
  CHECK(run_in(node, {"sh", "-c", "kill -SEGV $$"}).exited.signal_number() == SIGSEGV);
  CHECK(run_in(node, {"no-such-program"}).exited.error() ==
        "execute 'no-such-program': No such file or directory");
  auto unknown = launch_of(1, {"true"});
  unknown.add_capabilities("cap_make_coffee");
  CHECK(run_in(node, unknown).exited.error().starts_with("unknown capability"));
  auto nowhere = launch_of(1, {"true"});
  nowhere.set_working_directory("/no/such/folder");
  CHECK(run_in(node, nowhere).exited.error().find("/no/such/folder") != std::string::npos);
}

TEST_CASE("a signal reaches one program with its group, or all of the node") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  Node& node = fleet.nodes()[0];
  node.launch(launch_of(1, {"sh", "-c", "sleep 1000; true"}));
  node.launch(launch_of(2, {"sleep", "1000"}));
  REQUIRE(next_event(node).launched().program() == 1);
  REQUIRE(next_event(node).launched().program() == 2);

  node.signal(1, SIGTERM);
  CHECK(await_exit(node, 1).signal_number() == SIGTERM);
  node.signal_all(SIGINT);
  CHECK(await_exit(node, 2).signal_number() == SIGINT);

  CHECK(run_in(node, {"true"}).exited.exit_code() == 0);
}

TEST_CASE("a program gets its control socket as descriptor 3") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  Node& node = fleet.nodes()[0];
  std::array<int, 2> ends{};
  posix::check("socketpair", ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()));
  const posix::UniqueFd own{ends[0]};
  posix::UniqueFd other{ends[1]};

  node.launch(launch_of(1, {"sh", "-c", "echo $CUSCUS_CONTROL_FD >&3"}), -1, other.get());
  other.reset();

  CHECK(await_exit(node, 1).exit_code() == 0);
  std::array<char, 8> text{};
  CHECK(::recv(own.get(), text.data(), text.size(), MSG_DONTWAIT) == 2);
  CHECK(std::string{text.data()} == "3\n");
  // Nobody in the node kept a copy.
  CHECK(::recv(own.get(), text.data(), text.size(), MSG_DONTWAIT) == 0);
}

TEST_CASE("an init survives what programs do") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  Node& node = fleet.nodes()[0];

  SECTION("crashing a hundred times") {
    for (int i = 0; i < 100; ++i) {
      CHECK(run_in(node, {"sh", "-c", "kill -ABRT $$"}).exited.signal_number() == SIGABRT);
    }
  }
  SECTION("killing everything in sight as root") {
    auto launch = launch_of(1, {"sh", "-c", "kill -9 -1; kill -9 1; exit 5"});
    launch.set_uid(0);
    launch.set_gid(0);
    CHECK(run_in(node, launch).exited.exit_code() == 5);
  }
  SECTION("leaving orphans by the hundred") {
    CHECK(run_in(node, {"sh", "-c", "for i in $(seq 300); do true & done; exit 6"})
              .exited.exit_code() == 6);
  }
  SECTION("leaving a daemon behind") {
    CHECK(run_in(node, {"sh", "-c", "setsid sleep 1000 & exit 7"}).exited.exit_code() == 7);
    node.signal_all(SIGKILL);
  }

  // Reaping may lag behind the last signal, so ask until only init and the shell are left.
  std::string processes;
  for (int attempt = 0; attempt < 200; ++attempt) {
    processes = run_in(node, {"sh", "-c", kListProcesses}).output;
    if (processes.find(' ') == processes.rfind(' ')) {
      break;
    }
  }
  CHECK(processes.starts_with("/proc/1 "));
  CHECK(processes.find(' ') == processes.rfind(' '));
}

TEST_CASE("a thousand ends are all told to an orchestrator that reads late") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet = lone_node();
  Node& node = fleet.nodes()[0];
  constexpr std::uint32_t kPrograms = 1000;

  for (std::uint32_t program = 0; program < kPrograms; ++program) {
    node.launch(launch_of(program, {"no-such-program"}));
  }

  for (std::uint32_t program = 0; program < kPrograms; ++program) {
    REQUIRE(next_event(node).exited().program() == program);
  }
}

TEST_CASE("a child with a uid of its own dies with its parent all the same") {
  CUSCUS_ROOT_ONLY();
  std::array<int, 2> ends{};
  posix::check("pipe2", ::pipe2(ends.data(), O_CLOEXEC));
  const posix::UniqueFd reader{ends[0]};
  const posix::UniqueFd writer{ends[1]};
  const pid_t parent = posix::check("fork", ::fork());
  if (parent == 0) {
    const auto child = posix::ChildProcess::spawn(
        {.arguments = {"sleep", "1000"},
         .identity = posix::ChildIdentity{.uid = node_uid(0), .gid = node_uid(0)}});
    const pid_t pid = child.pid();
    static_cast<void>(!::write(writer.get(), &pid, sizeof pid));
    for (;;) {
      ::pause();
    }
  }
  pid_t child = 0;
  REQUIRE(::read(reader.get(), &child, sizeof child) == sizeof child);
  const auto pidfd = posix::open_pidfd(child);

  ::kill(parent, SIGKILL);

  pollfd ended{.fd = pidfd.get(), .events = POLLIN, .revents = 0};
  CHECK(::poll(&ended, 1, 10'000) == 1);
}

TEST_CASE("an unprivileged child may use SCHED_FIFO where its parent may") {
  CUSCUS_ROOT_ONLY();
  auto child = posix::ChildProcess::spawn(
      {.arguments = {"chrt", "-f", "10", "true"},
       .identity = posix::ChildIdentity{.uid = service_uid(0), .gid = service_uid(0)},
       .realtime = true});

  CHECK(child.wait().succeeded());
}

}  // namespace
}  // namespace cuscus::node
