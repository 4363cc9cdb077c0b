// cuscus-init NAME [--ipv6] < HOSTS
//
// Pid 1 of one node's PID namespace. Started by the orchestrator inside fresh namespaces, with the
// control socket that CUSCUS_CONTROL_FD names; not for use by hand. It prepares the namespaces,
// says Ready (or Failure), then serves Launch and Signal until the socket closes. Its end is the
// end of everything in the node: the kernel kills what is left in the namespace.
#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <string_view>

#include "common/ipc/control_socket.h"
#include "common/posix/check.h"
#include "common/posix/unique_fd.h"
#include "orchestrator/init/node_setup.h"
#include "orchestrator/init/program_table.h"

namespace {

using cuscus::init::ProgramTable;
using cuscus::ipc::ControlSocket;
using cuscus::posix::check;
using cuscus::posix::UniqueFd;

constexpr int kControlFd = 3;  // what ChildProcess makes of CUSCUS_CONTROL_FD

/// All of standard input, without moving its offset: the file is common to all inits of a run.
std::string read_hosts() {
  std::string text;
  std::array<char, 16384> chunk{};
  for (;;) {
    const ssize_t got =
        ::pread(STDIN_FILENO, chunk.data(), chunk.size(), static_cast<off_t>(text.size()));
    if (got <= 0) {
      return text;  // also where there is no file, such as /dev/null
    }
    text.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

/// Children's ends become readable; everything else that would end a process is left to default,
/// which for pid 1 means that nobody in the namespace can send it.
UniqueFd child_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGCHLD);
  static_cast<void>(::pthread_sigmask(SIG_BLOCK, &set, nullptr));  // fails for bad arguments only
  return UniqueFd{check("signalfd", ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK))};
}

/// Sends what the socket has room for.
void flush(ProgramTable& programs, ControlSocket& control) {
  auto& outbox = programs.outbox();
  while (!outbox.empty() && control.try_send(outbox.front())) {
    outbox.pop_front();
  }
}

void handle(ProgramTable& programs, ControlSocket::Received received) {
  if (received.envelope.has_launch()) {
    programs.launch(received.envelope.launch(), std::move(received.descriptors));
  } else if (received.envelope.has_signal()) {
    programs.signal(received.envelope.signal());
  }
}

/// Until the orchestrator closes the socket, by a PeerError.
[[noreturn]] void serve(ControlSocket& control, const UniqueFd& signals) {
  ProgramTable programs;
  for (;;) {
    flush(programs, control);
    const short wanted = programs.outbox().empty() ? POLLIN : POLLIN | POLLOUT;
    std::array<pollfd, 2> sources{{{.fd = control.fd(), .events = wanted, .revents = 0},
                                   {.fd = signals.get(), .events = POLLIN, .revents = 0}}};
    if (::poll(sources.data(), sources.size(), -1) < 0) {
      if (errno == EINTR) {
        continue;
      }
      cuscus::posix::throw_errno("poll");
    }
    signalfd_siginfo ignored{};
    while (::read(signals.get(), &ignored, sizeof ignored) > 0) {
    }
    while (auto received = control.try_receive()) {
      handle(programs, std::move(*received));
    }
    // Always: one SIGCHLD may stand for many ends.
    programs.reap();
  }
}

void run(const cuscus::init::NodeSetup& setup, ControlSocket& control) {
  const UniqueFd signals = child_signals();
  cuscus::proto::Envelope answer;
  try {
    cuscus::init::set_up_node(setup);
    answer.mutable_ready();
  } catch (const std::exception& error) {
    answer.mutable_failure()->set_text(error.what());
    control.send(answer);
    throw;
  }
  control.send(answer);
  serve(control, signals);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || ::getpid() != 1) {
    std::fputs("cuscus-init is started by 'cuscus run'\n", stderr);
    return 2;
  }
  try {
    check("CUSCUS_CONTROL_FD", ::fcntl(kControlFd, F_SETFD, FD_CLOEXEC));
    ControlSocket control{UniqueFd{kControlFd}};
    run({.host_name = argv[1],
         .hosts_text = read_hosts(),
         .ipv6 = argc > 2 && std::string_view{argv[2]} == "--ipv6"},
        control);
  } catch (const cuscus::ipc::PeerError&) {
    return 0;  // the run is over
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cuscus-init %s: %s\n", argv[1], error.what());
    return 1;
  }
  return 0;
}
