#include "common/posix/child_entry.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

namespace cuscus::posix {
namespace {

constexpr int kControlFd = 3;
constexpr int kExecFailed = 127;  // as shells have it
// Above every descriptor that the program gets, so that dup2() onto those overwrites nothing.
constexpr int kFirstSpareFd = 10;

[[noreturn]] void fail(int failure_fd, ChildStep step) noexcept {
  const ChildFailure failure{.step = step, .error = errno};
  static_cast<void>(!::write(failure_fd, &failure, sizeof failure));
  ::_exit(kExecFailed);
}

/// A copy out of the way of 0 to 3; -1 stays -1.
int move_up(int fd, int failure_fd) noexcept {
  if (fd < 0) {
    return fd;
  }
  const int moved = ::fcntl(fd, F_DUPFD_CLOEXEC, kFirstSpareFd);
  if (moved < 0) {
    fail(failure_fd, ChildStep::kDescriptors);
  }
  return moved;
}

void put_at(int from, int to, int failure_fd) noexcept {
  if (from >= 0 && ::dup2(from, to) < 0) {
    fail(failure_fd, ChildStep::kDescriptors);
  }
}

/// Puts standard descriptors and the control socket in their places; all others close on exec.
void arrange_descriptors(const ChildEntry& entry, int failure_fd) noexcept {
  const int input = move_up(entry.input_fd, failure_fd);
  const int output = move_up(entry.output_fd, failure_fd);
  const int control = move_up(entry.control_fd, failure_fd);
  put_at(input, STDIN_FILENO, failure_fd);
  put_at(output, STDOUT_FILENO, failure_fd);
  put_at(output, STDERR_FILENO, failure_fd);
  put_at(control, kControlFd, failure_fd);
  const unsigned first_other = control < 0 ? kControlFd : kControlFd + 1;
  if (::syscall(SYS_close_range, first_other, ~0U, CLOSE_RANGE_CLOEXEC) != 0) {
    fail(failure_fd, ChildStep::kDescriptors);
  }
}

/// The system calls themselves: glibc's wrappers want every thread of the process to follow, and
/// here glibc still believes in threads that only the parent has.
bool switch_identity(const ChildEntry& entry) noexcept {
  if ((entry.ambient | entry.until_exec) != 0 &&
      ::prctl(PR_SET_KEEPCAPS, 1UL, 0UL, 0UL, 0UL) != 0) {
    return false;
  }
  return ::syscall(SYS_setgroups, 0UL, nullptr) == 0 &&
         ::syscall(SYS_setresgid, entry.gid, entry.gid, entry.gid) == 0 &&
         ::syscall(SYS_setresuid, entry.uid, entry.uid, entry.uid) == 0;
}

bool keep_only(CapabilityMask ambient, CapabilityMask until_exec) noexcept {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> words{};
  const CapabilityMask now = ambient | until_exec;
  words[0].effective = words[0].permitted = static_cast<std::uint32_t>(now);
  words[1].effective = words[1].permitted = static_cast<std::uint32_t>(now >> 32U);
  words[0].inheritable = static_cast<std::uint32_t>(ambient);
  words[1].inheritable = static_cast<std::uint32_t>(ambient >> 32U);
  if (::syscall(SYS_capset, &header, words.data()) != 0) {
    return false;
  }
  for (int number = 0; number < 64; ++number) {
    if ((ambient & capability_bit(number)) != 0 &&
        ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, static_cast<unsigned long>(number), 0UL,
                0UL) != 0) {
      return false;
    }
  }
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1UL, 0UL, 0UL, 0UL) == 0;
}

void drop_rights(const ChildEntry& entry, int failure_fd) noexcept {
  // The bounding set stays: PR_SET_NO_NEW_PRIVS already keeps every exec from giving anything back,
  // while without its bits the kernel refuses to execute files that ask for them, as ping does.
  if (entry.switches_identity && !switch_identity(entry)) {
    fail(failure_fd, ChildStep::kIdentity);
  }
  if (!keep_only(entry.ambient, entry.until_exec)) {
    fail(failure_fd, ChildStep::kCapabilities);
  }
}

/// Dies with the parent from here on. The order matters: a change of uid clears the death signal,
/// and a parent that died before it was set would never send it.
void bind_to_parent(int parent_pidfd, int failure_fd) noexcept {
  if (::prctl(PR_SET_PDEATHSIG, static_cast<unsigned long>(SIGKILL), 0UL, 0UL, 0UL) != 0) {
    fail(failure_fd, ChildStep::kParentDeath);
  }
  pollfd parent{.fd = parent_pidfd, .events = POLLIN, .revents = 0};
  if (::poll(&parent, 1, 0) != 0) {
    ::_exit(kExecFailed);
  }
}

/// As a program expects them, whatever its parent ignores or blocks. Handlers are gone already.
void reset_signals() noexcept {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  for (int number = 1; number < NSIG; ++number) {
    static_cast<void>(::sigaction(number, &standard, nullptr));  // SIGKILL and SIGSTOP refuse
  }
  sigset_t none;
  ::sigemptyset(&none);
  static_cast<void>(::pthread_sigmask(SIG_SETMASK, &none, nullptr));
}

void apply_limits(const ChildEntry& entry, int failure_fd) noexcept {
  for (const ChildEntry::Limit& limit : entry.limits) {
    // The enum type of glibc's first parameter is not in POSIX; prlimit64 takes an int.
    if (::syscall(SYS_prlimit64, 0, limit.resource, &limit.value, nullptr) != 0 && limit.required) {
      fail(failure_fd, ChildStep::kResourceLimits);
    }
  }
}

}  // namespace

void run_child_entry(const ChildEntry& entry) noexcept {
  const int failure_fd = ::fcntl(entry.failure_fd, F_DUPFD_CLOEXEC, kFirstSpareFd);
  if (failure_fd < 0) {
    fail(entry.failure_fd, ChildStep::kDescriptors);
  }
  const int parent_pidfd = move_up(entry.parent_pidfd, failure_fd);
  reset_signals();
  if (entry.own_session && ::setsid() < 0) {
    fail(failure_fd, ChildStep::kSession);
  }
  if (entry.network_namespace_fd >= 0 && ::setns(entry.network_namespace_fd, CLONE_NEWNET) != 0) {
    fail(failure_fd, ChildStep::kNetworkNamespace);
  }
  apply_limits(entry, failure_fd);
  arrange_descriptors(entry, failure_fd);
  if (entry.drops_rights) {
    drop_rights(entry, failure_fd);
  }
  bind_to_parent(parent_pidfd, failure_fd);
  if (entry.working_directory != nullptr && ::chdir(entry.working_directory) != 0) {
    fail(failure_fd, ChildStep::kWorkingDirectory);
  }
  int error = ENOENT;
  for (const char* const executable : entry.executables) {
    ::execve(executable, entry.arguments, entry.environment);
    if (errno != ENOENT && errno != ENOTDIR) {
      // A file that is there but may not be executed is the better explanation, unless a later
      // folder of PATH has one that may.
      error = errno;
      if (errno != EACCES) {
        break;
      }
    }
  }
  errno = error;
  fail(failure_fd, ChildStep::kExec);
}

}  // namespace cuscus::posix
