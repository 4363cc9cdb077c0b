#include "orchestrator/node/enter_node.h"

#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <system_error>

#include "common/posix/check.h"
#include "orchestrator/node/node.h"

namespace cuscus::node {
namespace {

/// Whether the process is in a user namespace other than ours, so that we must enter that as well:
/// the kernel refuses to enter one's own a second time.
bool has_other_user_namespace(pid_t pid) {
  struct stat own {};
  struct stat other {};
  const std::string path = "/proc/" + std::to_string(pid) + "/ns/user";
  posix::check("stat of the own user namespace", ::stat("/proc/self/ns/user", &own));
  posix::check("stat of the node's user namespace", ::stat(path.c_str(), &other));
  return own.st_ino != other.st_ino;
}

}  // namespace

int enter_node(const NodeVisit& visit) {
  std::error_code no_directory;
  const auto directory = std::filesystem::current_path(no_directory);
  {
    const auto init = posix::open_pidfd(visit.init_pid);
    const int user = has_other_user_namespace(visit.init_pid) ? CLONE_NEWUSER : 0;
    posix::check("enter the node's namespaces", ::setns(init.get(), kNodeNamespaces | user));
  }
  // setns() into a mount namespace leaves us at its root.
  if (!no_directory && ::chdir(directory.c_str()) != 0) {
    posix::check("chdir to /", ::chdir("/"));
  }
  // A process stays in its PID namespace; only its children are born in the one it has entered.
  auto child = posix::ChildProcess::spawn({.arguments = visit.arguments,
                                           .environment = visit.environment,
                                           .input_fd = STDIN_FILENO,
                                           .identity = visit.identity,
                                           .own_session = false});
  // The terminal sends these to both of us; they are meant for the program.
  ::signal(SIGINT, SIG_IGN);
  ::signal(SIGQUIT, SIG_IGN);
  const posix::ExitStatus status = child.wait();
  constexpr int kSignalBase = 128;
  return status.signal_number == 0 ? status.exit_code : kSignalBase + status.signal_number;
}

}  // namespace cuscus::node
