#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/posix/child_process.h"
#include "orchestrator/app/component.h"
#include "orchestrator/app/run_memories.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/rights.h"
#include "orchestrator/plan/plan.h"
#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {

/// A program inside a node: our agent, our ground station, or the scenario's own command.
struct NodeProgram {
  std::uint32_t number;  ///< In Launch, Launched, Exited; index in NodeCrew::programs().
  std::uint32_t node;
  std::string name;  ///< "uav3", "uav3 command", "gcs"
  const Program* plan;
  std::unique_ptr<Component> component;  ///< Of our own programs, once launched.
  bool launched{false};
  std::optional<posix::ExitStatus> status;  ///< How it ended.
  std::string error;                        ///< Why it could not be started.
  double ended_at_s{0.0};                   ///< SimTime.
  bool ended_early{false};                  ///< Before anybody asked it to.
  bool killed{false};                       ///< At the end of the run, for not stopping.

  [[nodiscard]] bool has_ended() const { return status.has_value() || !error.empty(); }
};

/// Everything that runs inside the nodes.
class NodeCrew {
 public:
  struct Surroundings {
    const Plan& plan;
    const RunMemories& memories;
    node::Rights rights;
    std::filesystem::path programs;  ///< Folder of our own executables.
    const RunDirectory& directory;   ///< For one log per program.
    std::string run_id;
    int page_listener{-1};
    int city{-1};
  };

  /// `on_change` is called whenever a query below may answer differently.
  NodeCrew(boost::asio::io_context& loop, node::Fleet& fleet, Surroundings surroundings,
           std::function<void()> on_change);
  ~NodeCrew();
  NodeCrew(const NodeCrew&) = delete;
  NodeCrew& operator=(const NodeCrew&) = delete;

  /// Starts and configures our own programs, which then say Ready.
  void launch_own();
  /// Starts the scenario's commands.
  void launch_commands();
  [[nodiscard]] bool own_are_ready() const { return not_ready().empty(); }
  /// Names of our own programs that have not said Ready: "uav3, gcs".
  [[nodiscard]] std::string not_ready() const;

  void start(std::int64_t start_monotonic_ns);
  /// Asks all to end: Stop to our own, SIGINT to commands.
  void stop(const std::string& reason);
  /// SIGTERM to commands that still run.
  void terminate();
  /// SIGKILL to everything that still runs.
  void kill();
  [[nodiscard]] bool all_have_ended() const;

  [[nodiscard]] const std::vector<NodeProgram>& programs() const noexcept { return programs_; }
  [[nodiscard]] std::vector<NodeProgram>& programs() noexcept { return programs_; }
  /// Why the run cannot go on: a program ended whose end fails the run, a node's init is dead.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  /// A node's agent's flight state; empty when it has none.
  [[nodiscard]] std::string state_of(std::uint32_t node) const;
  /// SimTime for ended_at_s, once the run has started.
  void set_clock(std::function<double()> sim_time_s) { sim_time_s_ = std::move(sim_time_s); }

 private:
  void launch(NodeProgram& program);
  void configure(NodeProgram& program);
  void watch(std::uint32_t node);
  void drain(std::uint32_t node);
  void note_exit(const proto::Exited& exited);
  [[nodiscard]] posix::ChildIdentity identity_of(const NodeProgram& program) const;

  boost::asio::io_context& loop_;
  node::Fleet& fleet_;
  Surroundings surroundings_;
  std::function<void()> on_change_;
  std::function<double()> sim_time_s_;
  std::vector<NodeProgram> programs_;
  std::vector<std::unique_ptr<boost::asio::posix::stream_descriptor>> watches_;  // by node
  std::string trouble_;
  bool stopping_{false};
};

}  // namespace cuscus::orchestrator
