#include "common/posix/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <stdexcept>
#include <string>
#include <system_error>

#include "common/posix/check.h"

namespace cuscus::posix {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> kEnvironment{"PATH=/usr/bin:/bin", "GREETING=hello"};

UniqueFd memory_file() {
  return UniqueFd{check("memfd_create", ::memfd_create("output", MFD_CLOEXEC))};
}

std::string content_of(const UniqueFd& file) {
  std::string text(64 * 1024, '\0');
  text.resize(
      static_cast<std::size_t>(check("pread", ::pread(file.get(), text.data(), text.size(), 0))));
  return text;
}

/// What a shell script prints; fails the test when it does not exit with 0.
std::string output_of(const std::string& script) {
  const auto output = memory_file();
  auto child = ChildProcess::spawn(
      {.arguments = {"sh", "-c", script}, .environment = kEnvironment, .output_fd = output.get()});
  CHECK(child.wait() == ExitStatus{});
  return content_of(output);
}

TEST_CASE("a child's exit code is reported") {
  auto child = ChildProcess::spawn({.arguments = {"sh", "-c", "exit 7"}});

  CHECK(child.wait() == ExitStatus{.exit_code = 7});
}

TEST_CASE("the signal that ends a child is reported") {
  auto child = ChildProcess::spawn({.arguments = {"sh", "-c", "kill -SEGV $$"}});

  CHECK(child.wait() == ExitStatus{.signal_number = SIGSEGV});
}

TEST_CASE("a missing executable is an error of the parent") {
  CHECK_THROWS_WITH(ChildProcess::spawn({.arguments = {"no-such-program"}}),
                    "execute 'no-such-program': No such file or directory");
  CHECK_THROWS_WITH(ChildProcess::spawn({.arguments = {"/dev/null"}}),
                    "execute '/dev/null': Permission denied");
}

TEST_CASE("a missing working directory is an error of the parent") {
  CHECK_THROWS_WITH(
      ChildProcess::spawn({.arguments = {"true"}, .working_directory = "/no/such/folder"}),
      "start 'true': change to working directory '/no/such/folder': No such file or directory");
}

TEST_CASE("an unknown capability and an empty command are refused before anything starts") {
  CHECK_THROWS_AS(
      ChildProcess::spawn(
          {.arguments = {"true"}, .identity = ChildIdentity{.capabilities = {"cap_make_coffee"}}}),
      std::invalid_argument);
  CHECK_THROWS_AS(ChildProcess::spawn({}), std::invalid_argument);
}

TEST_CASE("a child has the given environment and directory and no others") {
  const auto output = memory_file();

  auto child = ChildProcess::spawn({.arguments = {"env"},
                                    .environment = kEnvironment,
                                    .working_directory = "/",
                                    .output_fd = output.get()});

  CHECK(child.wait().succeeded());
  CHECK(content_of(output) == "PATH=/usr/bin:/bin\nGREETING=hello\n");
}

TEST_CASE("a child inherits no descriptor that it was not given") {
  // Without O_CLOEXEC on purpose: such leaks are what close_range() is for.
  const UniqueFd leak{check("open", ::open("/dev/null", O_RDONLY))};

  // ls itself has the folder open as 3.
  CHECK(output_of("exec ls /proc/self/fd") == "0\n1\n2\n3\n");
}

TEST_CASE("a control socket becomes descriptor 3 and is named in the environment") {
  std::array<int, 2> ends{};
  check("socketpair", ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()));
  const UniqueFd own{ends[0]};
  const UniqueFd other{ends[1]};

  auto child = ChildProcess::spawn({.arguments = {"sh", "-c", "echo fd $CUSCUS_CONTROL_FD >&3"},
                                    .environment = kEnvironment,
                                    .control_fd = other.get()});

  CHECK(child.wait().succeeded());
  std::array<char, 16> text{};
  const auto got = ::recv(own.get(), text.data(), text.size(), MSG_DONTWAIT);
  CHECK(std::string{text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))} == "fd 3\n");
}

TEST_CASE("a child starts with the signals that programs expect") {
  ::signal(SIGPIPE, SIG_IGN);
  sigset_t blocked;
  ::sigemptyset(&blocked);
  ::sigaddset(&blocked, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &blocked, nullptr);

  const auto status = output_of("exec grep -E 'SigBlk|SigIgn' /proc/self/status");

  ::pthread_sigmask(SIG_UNBLOCK, &blocked, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  CHECK(status == "SigBlk:\t0000000000000000\nSigIgn:\t0000000000000000\n");
}

TEST_CASE("the limit of open files is the child's own") {
  const auto output = memory_file();

  auto child = ChildProcess::spawn({.arguments = {"sh", "-c", "ulimit -n"},
                                    .environment = kEnvironment,
                                    .output_fd = output.get(),
                                    .open_files = 200});

  CHECK(child.wait().succeeded());
  CHECK(content_of(output) == "200\n");
}

TEST_CASE("waiting has a limit, and signals reach a child by its pidfd") {
  auto child = ChildProcess::spawn({.arguments = {"sleep", "1000"}});

  CHECK_FALSE(child.try_wait());
  CHECK_FALSE(child.wait_for(1ms));
  CHECK(child.send_signal(SIGTERM));

  CHECK(child.wait() == ExitStatus{.signal_number = SIGTERM});
  CHECK_FALSE(child.send_signal(SIGTERM));
}

TEST_CASE("a child is killed with the object that owns it") {
  UniqueFd pidfd;
  {
    const auto child = ChildProcess::spawn({.arguments = {"sleep", "1000"}});
    pidfd = open_pidfd(child.pid());
  }

  pollfd ended{.fd = pidfd.get(), .events = POLLIN, .revents = 0};
  CHECK(::poll(&ended, 1, 0) == 1);
}

TEST_CASE("a child dies with its parent") {
  std::array<int, 2> ends{};
  check("pipe2", ::pipe2(ends.data(), O_CLOEXEC));
  const UniqueFd reader{ends[0]};
  const UniqueFd writer{ends[1]};
  const pid_t parent = check("fork", ::fork());
  if (parent == 0) {
    const auto child = ChildProcess::spawn({.arguments = {"sleep", "1000"}});
    const pid_t pid = child.pid();
    static_cast<void>(!::write(writer.get(), &pid, sizeof pid));
    for (;;) {
      ::pause();
    }
  }
  pid_t child = 0;
  REQUIRE(::read(reader.get(), &child, sizeof child) == sizeof child);
  const auto pidfd = open_pidfd(child);

  ::kill(parent, SIGKILL);

  pollfd ended{.fd = pidfd.get(), .events = POLLIN, .revents = 0};
  CHECK(::poll(&ended, 1, 10'000) == 1);
}

TEST_CASE("a child without rights cannot get any back") {
  const auto output = memory_file();

  auto child = ChildProcess::spawn(
      {.arguments = {"grep", "-E", "Cap(Prm|Eff|Amb)|NoNewPrivs", "/proc/self/status"},
       .environment = kEnvironment,
       .output_fd = output.get(),
       .identity = ChildIdentity{.uid = ::geteuid(), .gid = ::getegid()}});

  CHECK(child.wait().succeeded());
  CHECK(content_of(output) ==
        "CapPrm:\t0000000000000000\nCapEff:\t0000000000000000\n"
        "CapAmb:\t0000000000000000\nNoNewPrivs:\t1\n");
}

}  // namespace
}  // namespace cuscus::posix
