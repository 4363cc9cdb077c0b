#include "orchestrator/init/program_table.h"

#include <sys/wait.h>

#include <csignal>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/posix/child_process.h"

namespace cuscus::init {

void ProgramTable::launch(const proto::Launch& launch, std::vector<posix::UniqueFd> descriptors) {
  try {
    const std::size_t expected = launch.has_control_socket() ? 2 : 1;
    if (descriptors.size() != expected && !(descriptors.empty() && expected == 1)) {
      throw std::invalid_argument{"a Launch came with " + std::to_string(descriptors.size()) +
                                  " descriptors instead of " + std::to_string(expected)};
    }
    posix::ChildSpecification specification{
        .arguments = {launch.arguments().begin(), launch.arguments().end()},
        .environment = {launch.environment().begin(), launch.environment().end()},
        .working_directory = launch.working_directory(),
        .output_fd = descriptors.empty() ? -1 : descriptors[0].get(),
        .control_fd = launch.has_control_socket() ? descriptors[1].get() : -1,
        .identity = posix::ChildIdentity{.uid = launch.uid(),
                                         .gid = launch.gid(),
                                         .capabilities = {launch.capabilities().begin(),
                                                          launch.capabilities().end()}},
        .realtime = launch.realtime(),
        .open_files = kOpenFiles};
    auto child = posix::ChildProcess::spawn(specification);
    const pid_t pid = child.pid();
    // reap() waits for every child by its number; no pidfd is needed beside it.
    static_cast<void>(std::move(child).release());
    programs_[pid] = launch.program();
    report_launched(launch.program(), pid);
  } catch (const std::exception& error) {
    report_failed(launch.program(), error.what());
  }
}

void ProgramTable::report_launched(std::uint32_t program, pid_t pid) {
  proto::Launched& launched = *outbox_.emplace_back().mutable_launched();
  launched.set_program(program);
  launched.set_pid(pid);
}

void ProgramTable::report_failed(std::uint32_t program, const std::string& error) {
  proto::Exited& exited = *outbox_.emplace_back().mutable_exited();
  exited.set_program(program);
  exited.set_error(error);
}

void ProgramTable::signal(const proto::Signal& signal) {
  if (signal.program() == kAllPrograms) {
    // As pid 1 of the namespace: everybody but itself.
    static_cast<void>(::kill(-1, signal.signal_number()));
    return;
  }
  for (const auto& [pid, program] : programs_) {
    if (program == signal.program()) {
      // Programs lead a session, hence a group, of their own. Not reaped yet, so the number is
      // theirs.
      static_cast<void>(::kill(-pid, signal.signal_number()));
    }
  }
}

void ProgramTable::reap() {
  for (;;) {
    siginfo_t info{};
    if (::waitid(P_ALL, 0, &info, WEXITED | WNOHANG) != 0 || info.si_pid == 0) {
      return;
    }
    const auto found = programs_.find(info.si_pid);
    if (found == programs_.end()) {
      continue;  // an orphan of some program
    }
    proto::Exited& exited = *outbox_.emplace_back().mutable_exited();
    exited.set_program(found->second);
    if (info.si_code == CLD_EXITED) {
      exited.set_exit_code(info.si_status);
    } else {
      exited.set_signal_number(info.si_status);
    }
    programs_.erase(found);
  }
}

}  // namespace cuscus::init
