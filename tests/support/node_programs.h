#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/posix/unique_fd.h"
#include "orchestrator/node/node.h"
#include "proto/control.pb.h"

namespace cuscus::test {

/// How a program of a node went.
struct ProgramRun {
  proto::Exited exited;
  std::string output;
};

/// A Launch of `arguments` as node 0's own user, without capabilities.
[[nodiscard]] proto::Launch launch_of(std::uint32_t program,
                                      const std::vector<std::string>& arguments);

/// An empty file in memory, and what has been written to one.
[[nodiscard]] posix::UniqueFd memory_file();
[[nodiscard]] std::string content_of(const posix::UniqueFd& file);

/// The next Launched or Exited of a node. @throws std::runtime_error after ten seconds.
[[nodiscard]] proto::Envelope next_event(node::Node& node);
/// The end of a program; what comes before it is passed over.
[[nodiscard]] proto::Exited await_exit(node::Node& node, std::uint32_t program);

/// Runs a program in a node until it ends.
ProgramRun run_in(node::Node& node, const proto::Launch& launch);
ProgramRun run_in(node::Node& node, const std::vector<std::string>& arguments);

}  // namespace cuscus::test
