#include "common/posix/child_process.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/posix/capability_set.h"
#include "common/posix/check.h"
#include "common/posix/child_entry.h"

// After <sched.h>, whose CLONE_... it repeats.
#include <linux/sched.h>

namespace cuscus::posix {
namespace {

constexpr std::string_view kDefaultPath = "/usr/local/bin:/usr/bin:/bin";
constexpr rlim_t kRealtimePriorityLimit = 60;

std::string_view path_of(const std::vector<std::string>& environment) {
  for (const std::string& entry : environment) {
    if (entry.starts_with("PATH=")) {
      return std::string_view{entry}.substr(5);
    }
  }
  return kDefaultPath;
}

/// The files that exec tries for `name`, in order.
std::vector<std::string> candidates(const std::string& name,
                                    const std::vector<std::string>& environment) {
  if (name.find('/') != std::string::npos) {
    return {name};
  }
  std::vector<std::string> found;
  std::string_view rest = path_of(environment);
  while (!rest.empty()) {
    const auto end = std::min(rest.find(':'), rest.size());
    if (end > 0) {
      found.push_back(std::string{rest.substr(0, end)} + '/' + name);
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return found;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) {
    pointers.push_back(text.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

/// What must be allocated before the clone. ChildEntry points into it.
struct Preparation {
  std::vector<std::string> arguments;
  std::vector<std::string> environment;
  std::vector<std::string> executables;
  std::vector<char*> argument_pointers;
  std::vector<char*> environment_pointers;
  std::vector<const char*> executable_pointers;
  std::vector<ChildEntry::Limit> limits;
  CapabilityMask ambient{0};
  CapabilityMask until_exec{0};
  UniqueFd null_device;
};

bool may_raise(int resource, rlim_t wanted) {
  rlimit limit{};
  return ::syscall(SYS_prlimit64, 0, resource, nullptr, &limit) == 0 && limit.rlim_max >= wanted;
}

bool switches_identity(const ChildIdentity& identity) {
  return identity.uid != ::geteuid() || identity.gid != ::getegid();
}

void prepare_realtime(Preparation& prepared) {
  const CapabilityMask have = effective_capabilities();
  const bool raises = (have & capability_bit(CAP_SYS_RESOURCE)) != 0;
  const auto grant = [&](int resource, rlim_t wanted, int stand_in) {
    if (raises || may_raise(resource, wanted)) {
      prepared.limits.push_back({resource, {wanted, wanted}, false});
    } else {
      prepared.ambient |= have & capability_bit(stand_in);
    }
  };
  grant(RLIMIT_RTPRIO, kRealtimePriorityLimit, CAP_SYS_NICE);
  grant(RLIMIT_MEMLOCK, RLIM_INFINITY, CAP_IPC_LOCK);
}

Preparation prepare(const ChildSpecification& specification) {
  if (specification.arguments.empty()) {
    throw std::invalid_argument{"a program needs at least its own name as an argument"};
  }
  Preparation prepared;
  prepared.arguments = specification.arguments;
  prepared.environment = specification.environment;
  if (specification.control_fd >= 0) {
    prepared.environment.emplace_back("CUSCUS_CONTROL_FD=3");
  }
  prepared.executables = candidates(specification.arguments.front(), specification.environment);
  prepared.argument_pointers = pointers_to(prepared.arguments);
  prepared.environment_pointers = pointers_to(prepared.environment);
  for (const std::string& path : prepared.executables) {
    prepared.executable_pointers.push_back(path.c_str());
  }
  if (specification.identity) {
    prepared.ambient = capability_mask(specification.identity->capabilities);
    if (switches_identity(*specification.identity) && specification.identity->uid != 0) {
      prepared.until_exec = effective_capabilities() & capability_bit(CAP_DAC_OVERRIDE);
    }
  }
  if (specification.realtime) {
    prepare_realtime(prepared);
  }
  if (specification.open_files) {
    rlimit limit{};
    check("getrlimit(RLIMIT_NOFILE)", ::getrlimit(RLIMIT_NOFILE, &limit));
    limit.rlim_cur = std::min<rlim_t>(*specification.open_files, limit.rlim_max);
    prepared.limits.push_back({RLIMIT_NOFILE, limit, true});
  }
  if (specification.input_fd < 0) {
    prepared.null_device =
        UniqueFd{check("open /dev/null", ::open("/dev/null", O_RDONLY | O_CLOEXEC))};
  }
  return prepared;
}

ChildEntry entry_of(const ChildSpecification& specification, const Preparation& prepared,
                    int failure_fd, int parent_pidfd) {
  const bool drops = specification.identity.has_value();
  const uid_t uid = drops ? specification.identity->uid : 0;
  const gid_t gid = drops ? specification.identity->gid : 0;
  return {
      .executables = prepared.executable_pointers,
      .arguments = prepared.argument_pointers.data(),
      .environment = prepared.environment_pointers.data(),
      .working_directory = specification.working_directory.empty()
                               ? nullptr
                               : specification.working_directory.c_str(),
      .input_fd = specification.input_fd < 0 ? prepared.null_device.get() : specification.input_fd,
      .output_fd = specification.output_fd,
      .control_fd = specification.control_fd,
      .failure_fd = failure_fd,
      .parent_pidfd = parent_pidfd,
      .network_namespace_fd = specification.network_namespace_fd,
      .own_session = specification.own_session,
      .limits = prepared.limits,
      .drops_rights = drops,
      .switches_identity = drops && switches_identity(*specification.identity),
      .uid = uid,
      .gid = gid,
      .ambient = prepared.ambient,
      .until_exec = prepared.until_exec};
}

std::string describe(ChildStep step, const ChildSpecification& specification) {
  const std::string& program = specification.arguments.front();
  const std::string start = "start '" + program + "': ";
  switch (step) {
    case ChildStep::kSession:
      return start + "new session";
    case ChildStep::kNetworkNamespace:
      return start + "enter its network namespace";
    case ChildStep::kDescriptors:
      return start + "arrange its descriptors";
    case ChildStep::kResourceLimits:
      return start + "set its resource limits";
    case ChildStep::kIdentity:
      return start + "become uid " + std::to_string(specification.identity->uid) + ", gid " +
             std::to_string(specification.identity->gid);
    case ChildStep::kCapabilities:
      return start + "drop capabilities";
    case ChildStep::kParentDeath:
      return start + "set the parent-death signal";
    case ChildStep::kWorkingDirectory:
      return start + "change to working directory '" + specification.working_directory + "'";
    case ChildStep::kExec:
      return "execute '" + program + "'";
  }
  return start + "unknown step";
}

/// Waits until the child has become the program, or reports why not.
std::optional<ChildFailure> read_failure(const UniqueFd& pipe_end) {
  ChildFailure failure{};
  ssize_t got = -1;
  while ((got = ::read(pipe_end.get(), &failure, sizeof failure)) < 0 && errno == EINTR) {
  }
  check("read from a new child", got);
  return got == sizeof failure ? std::optional{failure} : std::nullopt;
}

}  // namespace

ChildProcess ChildProcess::spawn(const ChildSpecification& specification) {
  const Preparation prepared = prepare(specification);
  std::array<int, 2> ends{};
  check("pipe2", ::pipe2(ends.data(), O_CLOEXEC));
  const UniqueFd failure_reader{ends[0]};
  UniqueFd failure_writer{ends[1]};
  const UniqueFd own_pidfd = open_pidfd(::getpid());
  const ChildEntry entry = entry_of(specification, prepared, failure_writer.get(), own_pidfd.get());

  int pidfd = -1;
  clone_args arguments{};
  arguments.flags = CLONE_PIDFD | CLONE_CLEAR_SIGHAND | specification.namespaces;
  arguments.pidfd = reinterpret_cast<std::uintptr_t>(&pidfd);
  arguments.exit_signal = SIGCHLD;
  const auto pid =
      check("clone3", static_cast<pid_t>(::syscall(SYS_clone3, &arguments, sizeof arguments)));
  if (pid == 0) {
    run_child_entry(entry);
  }
  ChildProcess child{pid, UniqueFd{pidfd}};
  failure_writer.reset();
  if (const auto failure = read_failure(failure_reader)) {
    throw std::system_error{failure->error, std::system_category(),
                            describe(failure->step, specification)};
  }
  return child;
}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    kill_and_reap();
    pid_ = other.pid_;
    pidfd_ = std::move(other.pidfd_);
  }
  return *this;
}

ChildProcess::~ChildProcess() { kill_and_reap(); }

void ChildProcess::kill_and_reap() noexcept {
  if (pidfd_) {
    static_cast<void>(::syscall(SYS_pidfd_send_signal, pidfd_.get(), SIGKILL, nullptr, 0));
    siginfo_t info{};
    while (::waitid(P_PIDFD, static_cast<id_t>(pidfd_.get()), &info, WEXITED) != 0 &&
           errno == EINTR) {
    }
    pidfd_.reset();
  }
}

bool ChildProcess::send_signal(int signal_number) {
  if (!pidfd_) {
    return false;
  }
  if (::syscall(SYS_pidfd_send_signal, pidfd_.get(), signal_number, nullptr, 0) != 0) {
    if (errno == ESRCH) {
      return false;
    }
    throw_errno("pidfd_send_signal");
  }
  return true;
}

std::optional<ExitStatus> ChildProcess::wait(int options) {
  if (!pidfd_) {
    throw std::logic_error{"a child process was waited for twice"};
  }
  siginfo_t info{};
  while (::waitid(P_PIDFD, static_cast<id_t>(pidfd_.get()), &info, WEXITED | options) != 0) {
    if (errno != EINTR) {
      throw_errno("waitid");
    }
  }
  if (info.si_pid == 0) {
    return std::nullopt;  // WNOHANG, and it runs
  }
  pidfd_.reset();
  return info.si_code == CLD_EXITED ? ExitStatus{.exit_code = info.si_status}
                                    : ExitStatus{.signal_number = info.si_status};
}

ExitStatus ChildProcess::wait() { return wait(0).value(); }

std::optional<ExitStatus> ChildProcess::try_wait() { return wait(WNOHANG); }

std::optional<ExitStatus> ChildProcess::wait_for(std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::max(
        deadline - std::chrono::steady_clock::now(), std::chrono::steady_clock::duration::zero()));
    pollfd ended{.fd = pidfd_.get(), .events = POLLIN, .revents = 0};
    const int ready = ::poll(&ended, 1, static_cast<int>(left.count()));
    if (ready > 0) {
      return wait(WNOHANG);
    }
    if (ready == 0) {
      return std::nullopt;
    }
    if (errno != EINTR) {
      throw_errno("poll of a pidfd");
    }
  }
}

UniqueFd open_pidfd(pid_t pid) {
  return UniqueFd{static_cast<int>(check("pidfd_open", ::syscall(SYS_pidfd_open, pid, 0)))};
}

}  // namespace cuscus::posix
