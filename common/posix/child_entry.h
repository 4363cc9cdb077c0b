#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <cstdint>
#include <span>

#include "common/posix/capability_set.h"

namespace cuscus::posix {

/// What a new child does between clone and exec, in order; sent back when one of them fails.
enum class ChildStep : std::int32_t {
  kSession,
  kNetworkNamespace,
  kDescriptors,
  kResourceLimits,
  kIdentity,
  kCapabilities,
  kParentDeath,
  kWorkingDirectory,
  kExec,
};

/// What the child writes into its close-on-exec pipe when it cannot become the program.
struct ChildFailure {
  ChildStep step;
  std::int32_t error;  ///< errno
};

/// Everything a child needs, prepared by its parent: after a clone of a threaded process the child
/// may call async-signal-safe functions only (signal-safety(7)), so it must not allocate.
struct ChildEntry {
  struct Limit {
    int resource;
    rlimit value;
    bool required;  ///< Otherwise a refusal is ignored.
  };

  std::span<const char* const> executables;  ///< Tried in turn, as execvp() does with PATH.
  char* const* arguments;                    ///< Ends with a null pointer.
  char* const* environment;                  ///< Ends with a null pointer.
  const char* working_directory;             ///< Null: the parent's.
  int input_fd;
  int output_fd;   ///< -1: the parent's standard output and error.
  int control_fd;  ///< -1: none; otherwise becomes descriptor 3.
  int failure_fd;  ///< Takes one ChildFailure; close-on-exec.
  int parent_pidfd;
  int network_namespace_fd;  ///< -1: stays where it is.
  bool own_session;
  std::span<const Limit> limits;
  bool drops_rights;       ///< Whether the next four count.
  bool switches_identity;  ///< False where only one uid is mapped: then it stays what it is.
  uid_t uid;
  gid_t gid;
  CapabilityMask ambient;
  /// Kept up to the exec, which takes them away: what reaches a program in a folder that is closed
  /// to its uid, such as a home. Needs switches_identity to a uid that is not root's.
  CapabilityMask until_exec;
};

/// Turns the calling process, just cloned, into the program; never returns. Async-signal-safe.
[[noreturn]] void run_child_entry(const ChildEntry& entry) noexcept;

}  // namespace cuscus::posix
