#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/posix/unique_fd.h"
#include "orchestrator/app/emulator_processor.h"
#include "orchestrator/app/link_follower.h"
#include "orchestrator/app/node_crew.h"
#include "orchestrator/app/progress.h"
#include "orchestrator/app/run_memories.h"
#include "orchestrator/app/service.h"
#include "orchestrator/netlink/send_stamps.h"
#include "orchestrator/node/canary.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/rights.h"
#include "orchestrator/plan/plan.h"
#include "orchestrator/results/run_directory.h"

namespace cuscus::orchestrator {

/// What a run is carried out with.
struct RunSettings {
  std::string run_id;
  node::Rights rights{};
  std::filesystem::path programs;                     ///< Folder of our own executables.
  const RunDirectory& directory;                      ///< For one log per process.
  posix::UniqueFd page_listener;                      ///< Empty: no page.
  posix::UniqueFd city;                               ///< proto::CityModel; empty: there is none.
  posix::UniqueFd frame_log;                          ///< Empty: none is wanted.
  posix::UniqueFd reception_log;                      ///< Likewise.
  std::map<std::uint32_t, posix::UniqueFd> captures;  ///< Files, by node.
};

/// How a flight ended.
struct FlightEnd {
  enum class Kind { kCompleted, kInterrupted, kFailed, kStoppedLate };
  Kind kind{Kind::kCompleted};
  int signal_number{0};  ///< kInterrupted: what interrupted it.
  std::string reason;    ///< kFailed, kStoppedLate: why.
  double flown_s{0.0};   ///< SimTime reached.
};

/// One run in real time, from its first namespace to its last report. Everything it has made is
/// gone when this object is gone.
///
/// Members are declared in the order of set-up, so that the end undoes it backwards.
class LiveRun {
 public:
  /// Called every metrics period of the flight, with the SimTime [s].
  using OnSample = std::function<void(double sim_time_s)>;

  LiveRun(const Plan& plan, RunSettings settings);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Sets everything up. False when a signal or a failure came first; end() says which.
  bool set_up();
  /// Flies for the plan's duration, or until something ends the run; then stops every program.
  void fly(const OnSample& on_sample);

  [[nodiscard]] const FlightEnd& end() const noexcept { return end_; }
  [[nodiscard]] const RunMemories& memories() const noexcept { return memories_; }
  [[nodiscard]] const NodeCrew* crew() const noexcept { return crew_.get(); }
  [[nodiscard]] const Service* world() const noexcept { return world_.get(); }
  [[nodiscard]] const Service* netsim() const noexcept { return netsim_.get(); }
  /// Null when no vehicle has a camera.
  [[nodiscard]] const Service* camera() const noexcept { return camera_.get(); }
  /// Frames that the kernel dropped on the way to netsim, per node.
  [[nodiscard]] std::vector<std::uint64_t> tap_drops() const;
  /// Frames that the kernel dropped on their way from netsim to the nodes.
  [[nodiscard]] std::uint64_t backlog_drops() const {
    return processor_ ? processor_->backlog_drops() : 0;
  }
  /// What the world took from a node's program while it flew: motors that stop later were told to.
  [[nodiscard]] std::optional<shm::CommandTally> commands(std::uint32_t node) const;
  /// The longest time in flight for which nobody looked after the run.
  [[nodiscard]] std::chrono::nanoseconds longest_gap() const noexcept { return longest_gap_; }
  /// What the canary has seen, once it is quiet; null before there is one.
  [[nodiscard]] const node::CanaryTally* canary() const noexcept {
    return canary_ ? &canary_->tally() : nullptr;
  }
  /// The nodes' inits, by node, for the registry; empty before they are built.
  [[nodiscard]] std::vector<pid_t> init_pids() const;
  /// Told once the nodes are there.
  void on_nodes_built(std::function<void()> told) { on_nodes_built_ = std::move(told); }
  /// "tc-bpf", or why send stamps are not to be had.
  [[nodiscard]] const std::string& send_stamps_text() const noexcept { return send_stamps_text_; }

 private:
  /// Numbers of the nodes that fly.
  [[nodiscard]] std::vector<RunMemories::VehicleNode> vehicles() const;
  void start_world();
  void start_camera();
  void reserve_processor();
  void build_nodes();
  void start_netsim();
  void start_programs();
  void start_clock();
  void stop_all();
  void watch_signals();
  /// Runs the loop until `done`; throws RunFailed or RunInterrupted when the run cannot go on.
  void await(const std::function<std::string()>& what, std::chrono::milliseconds limit,
             const std::function<bool()>& done);
  /// Runs the loop until `done` or until `limit` has passed.
  bool settle(std::chrono::milliseconds limit, const std::function<bool()>& done);
  /// Throws when a signal or a failure ends the run.
  void check_trouble() const;
  void check_heartbeats();
  /// Says once that the run cannot become VALID any more; throws when it is to end then.
  void check_validity();
  void wait_step(std::chrono::steady_clock::time_point deadline);
  /// Runs what is ready, for a moment at most.
  void serve();
  /// Those that have been started, in that order.
  [[nodiscard]] std::vector<Service*> services() const;
  [[nodiscard]] std::string progress_text() const;
  [[nodiscard]] double sim_time_s() const;
  [[nodiscard]] posix::ChildSpecification service_specification(const char* program,
                                                                std::uint32_t service,
                                                                int output_fd) const;
  template <typename Body>
  bool guarded(const Body& body);

  const Plan& plan_;
  RunSettings settings_;
  boost::asio::io_context loop_{1};
  boost::asio::signal_set signals_;
  int signal_number_{0};
  int signals_seen_{0};
  FlightEnd end_;
  std::vector<std::optional<shm::CommandTally>> commands_;  // by node, once the flight is over
  std::chrono::nanoseconds longest_gap_{0};
  bool lost_validity_{false};
  std::string send_stamps_text_;
  std::function<void()> on_nodes_built_;
  std::int64_t start_monotonic_ns_{0};
  RunMemories memories_;
  std::unique_ptr<Service> world_;
  std::unique_ptr<Service> camera_;
  std::optional<EmulatorProcessor> processor_;
  std::optional<netlink::SendStampRing> send_stamps_;
  std::unique_ptr<node::Fleet> fleet_;
  std::unique_ptr<LinkFollower> links_;
  std::unique_ptr<node::Canary> canary_;
  std::unique_ptr<Service> netsim_;
  std::unique_ptr<NodeCrew> crew_;
};

}  // namespace cuscus::orchestrator
