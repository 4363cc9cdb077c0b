#pragma once

#include <sched.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "common/ipc/control_socket.h"
#include "common/posix/child_process.h"
#include "common/posix/network_namespace.h"
#include "common/posix/unique_fd.h"
#include "orchestrator/netlink/monitor_device.h"
#include "orchestrator/netlink/route_socket.h"
#include "orchestrator/netlink/tap_device.h"
#include "orchestrator/node/fabric.h"
#include "orchestrator/node/node_links.h"
#include "proto/control.pb.h"

namespace cuscus::node {

/// What every node has of its own, as flags of clone3() and setns().
inline constexpr int kNodeNamespaces =
    CLONE_NEWNET | CLONE_NEWPID | CLONE_NEWNS | CLONE_NEWUTS | CLONE_NEWIPC;

/// What all inits of a run are started with.
struct InitProgram {
  std::string path;   ///< cuscus-init.
  int hosts_fd{-1};   ///< A file that has the node's /etc/hosts; -1: they keep the host's.
  int output_fd{-1};  ///< Takes what inits have to complain about; -1: the caller's own.
};

/// cuscus-init, beside the running executable.
[[nodiscard]] std::string default_init_path();

/// A node: a set of namespaces with an init process, and wlan0 between it and netsim. All of it
/// goes with this object, or with the process that made it.
///
/// Its three steps are apart so that a fleet's inits can start side by
/// side; Fleet does all of them. Start it on a thread that lives as long as the process (see
/// ChildProcess).
class Node {
 public:
  /// Starts the node's init. It is not ready yet.
  [[nodiscard]] static Node start(NodeNetwork network, const InitProgram& program);

  /// Waits until the init has prepared its namespaces, but not longer than `limit`; whether it has.
  /// @throws std::runtime_error naming the node, with the init's reason.
  [[nodiscard]] bool await_ready(std::chrono::milliseconds limit);

  /// Builds wlan0 and what connects it. Once, when await_ready(). `fabric_routes` is of `fabric`.
  void build_links(const Fabric& fabric, netlink::RouteSocket& fabric_routes,
                   const Surroundings& surroundings);

  [[nodiscard]] const NodeNetwork& network() const noexcept { return network_; }
  [[nodiscard]] pid_t init_pid() const noexcept { return init_.pid(); }
  /// For poll(): readable once the node's init, hence the node, is dead.
  [[nodiscard]] int init_pidfd() const noexcept { return init_.pidfd(); }
  [[nodiscard]] const posix::NetworkNamespace& network_namespace() const { return *namespace_; }
  /// Where netsim reads and writes this node's frames; valid after build_links().
  [[nodiscard]] int tap_fd() const { return tap_->fd(); }
  /// Where netsim writes what mon0 shows; valid after build_links().
  [[nodiscard]] int monitor_fd() const { return monitor_->fd(); }
  /// Lets go of the TAP, so that another program can attach to it by its name.
  void close_tap() { tap_.reset(); }
  /// What wlan0 and, in the fabric, the TAP have counted and dropped.
  [[nodiscard]] netlink::LinkCounters tap_counters(const Fabric& fabric) const;

  /// For poll(): readable when try_receive() has something.
  [[nodiscard]] int control_fd() const noexcept { return control_.fd(); }
  /// Asks for a program; Launched or Exited will answer. Descriptors as in control.proto; -1: none.
  void launch(const proto::Launch& launch, int output_fd = -1, int program_control_fd = -1);
  /// Signals a program and its process group; nothing when the init is dead, and they with it.
  void signal(std::uint32_t program, int signal_number);
  /// Signals everything in the node but its init.
  void signal_all(int signal_number);
  /// The next Launched or Exited, if one is there. @throws ipc::PeerError when the init is dead.
  [[nodiscard]] std::optional<proto::Envelope> try_receive();

  /// Kills everything in the node, without waiting for it. The destructor waits.
  void kill();

 private:
  Node(NodeNetwork network, const InitProgram& program, ipc::ControlSocket own,
       ipc::ControlSocket init_end);

  NodeNetwork network_;
  ipc::ControlSocket control_;
  std::optional<netlink::TapDevice> tap_;
  std::optional<netlink::MonitorDevice> monitor_;
  posix::ChildProcess init_;  // dies before the TAP goes, so that nobody sees wlan0 vanish
  std::optional<posix::NetworkNamespace> namespace_;
};

}  // namespace cuscus::node
