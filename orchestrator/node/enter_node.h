#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "common/posix/child_process.h"

namespace cuscus::node {

/// What to run inside a running node.
struct NodeVisit {
  pid_t init_pid{};                      ///< The node's init, as the caller sees it.
  std::vector<std::string> arguments{};  ///< arguments[0] is searched in the PATH of environment.
  std::vector<std::string> environment{};
  /// Without: root of the node, with all the rights that the caller has.
  std::optional<posix::ChildIdentity> identity{};
};

/// Runs a program in all namespaces of a node, on the caller's terminal, and waits for it. Moves
/// the calling process into the node for good, so it must have one thread and is of no other use
/// after. The working directory stays where the node has it too.
///
/// Returns the program's exit code, or 128 + n when signal n ended it.
/// @throws std::system_error when there is no such node, or no such program.
int enter_node(const NodeVisit& visit);

}  // namespace cuscus::node
