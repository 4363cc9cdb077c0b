#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/posix/unique_fd.h"

namespace cuscus::posix {

/// Whom a child runs as. All capabilities but those named are gone, and no exec can bring one back.
/// The executable and the working directory are found with the parent's rights: a clone in a home
/// that others may not enter works.
struct ChildIdentity {
  uid_t uid{};
  gid_t gid{};
  std::vector<std::string> capabilities{};  ///< Ambient, such as "cap_net_raw".
};

/// What to start, and what it may see of its parent: nothing that is not named here.
struct ChildSpecification {
  /// arguments[0] is the executable; without a slash it is searched in the PATH of `environment`.
  /// With one it is relative to the working directory.
  std::vector<std::string> arguments{};
  std::vector<std::string> environment{};  ///< KEY=VALUE
  std::string working_directory{};         ///< Empty: the parent's.
  int input_fd{-1};                        ///< Standard input; -1: /dev/null.
  int output_fd{-1};                       ///< Standard output and error; -1: the parent's.
  int control_fd{-1};  ///< Becomes descriptor 3, and CUSCUS_CONTROL_FD=3 is added.
  /// The child's rights; none: it keeps the parent's. When uid and gid are the parent's own, only
  /// capabilities are dropped: in a user namespace with one mapped uid there is no other.
  std::optional<ChildIdentity> identity{};
  /// RLIMIT_RTPRIO 60 and RLIMIT_MEMLOCK unlimited, so that SCHED_FIFO and mlockall() work without
  /// rights. Where the parent may not raise these (no CAP_SYS_RESOURCE), cap_sys_nice and
  /// cap_ipc_lock stand in for them, as far as the parent has them; without either, the child has
  /// to do without.
  bool realtime{false};
  std::optional<std::uint64_t> open_files{};  ///< Soft RLIMIT_NOFILE, at most the hard one.
  int network_namespace_fd{-1};               ///< Entered before exec; -1: the parent's.
  std::uint64_t namespaces{0};                ///< CLONE_NEW... flags for clone3().
  bool own_session{true};                     ///< No controlling terminal, no common group.
};

/// How a process ended.
struct ExitStatus {
  int exit_code{0};      ///< Valid when signal_number is 0.
  int signal_number{0};  ///< The signal that ended it, or 0.

  [[nodiscard]] bool succeeded() const noexcept { return exit_code == 0 && signal_number == 0; }
  friend bool operator==(const ExitStatus&, const ExitStatus&) = default;
};

/// A child process, known by its pidfd: a number that no other process can ever get. The child is
/// killed when this object goes, and when the parent dies.
///
/// The kernel sends the parent-death signal when the *thread* that spawned ends. Spawn from a
/// thread that lives as long as the process, normally the main thread.
class ChildProcess {
 public:
  /// Starts the program and returns once it runs.
  /// @throws std::system_error naming the step that failed, also when it failed in the child: a
  ///   missing executable, a uid that is not mapped, a working directory that is not there.
  /// @throws std::invalid_argument for an unknown capability or for no arguments.
  [[nodiscard]] static ChildProcess spawn(const ChildSpecification& specification);

  ChildProcess(ChildProcess&&) noexcept = default;
  /// Kills and reaps the child held before.
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills with SIGKILL and reaps, unless it was waited for or released.
  ~ChildProcess();

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  /// For poll(): readable once the child has ended.
  [[nodiscard]] int pidfd() const noexcept { return pidfd_.get(); }

  /// Sends a signal; false when the child has ended.
  bool send_signal(int signal_number);

  /// How the child ended; waits for it. Reaped after that, so that it can be asked only once.
  ExitStatus wait();
  [[nodiscard]] std::optional<ExitStatus> try_wait();
  [[nodiscard]] std::optional<ExitStatus> wait_for(std::chrono::milliseconds limit);

  /// Gives up the child: it is neither killed nor reaped here. For a parent that reaps everything.
  [[nodiscard]] UniqueFd release() && { return std::move(pidfd_); }

 private:
  ChildProcess(pid_t pid, UniqueFd pidfd) noexcept : pid_{pid}, pidfd_{std::move(pidfd)} {}

  std::optional<ExitStatus> wait(int options);
  void kill_and_reap() noexcept;

  pid_t pid_;
  UniqueFd pidfd_;  // empty once reaped or released
};

/// A pidfd of an existing process. @throws std::system_error when there is none.
[[nodiscard]] UniqueFd open_pidfd(pid_t pid);

}  // namespace cuscus::posix
