#pragma once

#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "common/ipc/control_socket.h"
#include "common/posix/unique_fd.h"
#include "proto/control.pb.h"

namespace cuscus::init {

/// The programs of one node: starts them, passes signals on, notices every end. What it has to tell
/// waits in outbox() until the orchestrator reads, so that a slow one never stops the reaping.
///
/// Nothing here throws for what a program does, or for what could not be started.
class ProgramTable {
 public:
  /// All programs of the node, in Signal::program.
  static constexpr std::uint32_t kAllPrograms = 0xffffffff;
  /// Soft RLIMIT_NOFILE of programs; the orchestrator's own is raised for its many descriptors, and
  /// old programs loop up to theirs.
  static constexpr std::uint64_t kOpenFiles = 1024;

  /// Starts a program, with descriptors in the order that control.proto gives.
  void launch(const proto::Launch& launch, std::vector<posix::UniqueFd> descriptors);
  /// Signals a program and what it started in its process group, or everything in the node.
  void signal(const proto::Signal& signal);
  /// Reaps every child that has ended, orphans too.
  void reap();

  /// What is to be sent to the orchestrator, oldest first.
  [[nodiscard]] std::deque<proto::Envelope>& outbox() noexcept { return outbox_; }

 private:
  void report_launched(std::uint32_t program, pid_t pid);
  void report_failed(std::uint32_t program, const std::string& error);

  std::map<pid_t, std::uint32_t> programs_;
  std::deque<proto::Envelope> outbox_;
};

}  // namespace cuscus::init
