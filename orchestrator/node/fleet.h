#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "orchestrator/netlink/send_stamps.h"
#include "orchestrator/node/fabric.h"
#include "orchestrator/node/hosts_file.h"
#include "orchestrator/node/node.h"

namespace cuscus::node {

/// How a fleet's nodes are set up.
struct FleetOptions {
  std::string init_path{default_init_path()};
  int output_fd{-1};  ///< For what inits have to complain about; -1: the caller's standard error.
  /// Every node knows every other's Ethernet address from the start, so that no ARP occupies the
  /// air.
  bool static_neighbours{true};
  /// Every node's /etc/hosts has all nodes' names; off: it is the host's.
  bool hosts{true};
  const netlink::SendStampRing* send_stamps{};    ///< Null: no stamps. Outlives the building.
  std::span<const int> receive_processors{};      ///< See Surroundings.
  std::chrono::milliseconds ready_limit{10'000};  ///< For each node's init.
  /// Told after each step what has been done; may throw to end the building there.
  std::function<void(std::string_view step)> on_step{};
  /// Called every now and then while an init is waited for; may throw likewise.
  std::function<void()> on_wait{};
};

/// The fabric and all nodes of a run. Takes it all down when it goes: inits first, all at once.
class Fleet {
 public:
  /// Builds everything: inits side by side, then links one after the other.
  /// @throws std::runtime_error naming the node and what was attempted; nothing is left then.
  Fleet(std::span<const NodeNetwork> networks, const FleetOptions& options);
  ~Fleet();

  Fleet(Fleet&&) noexcept = default;
  Fleet& operator=(Fleet&&) = delete;
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  [[nodiscard]] const Fabric& fabric() const noexcept { return fabric_; }
  [[nodiscard]] std::vector<Node>& nodes() noexcept { return nodes_; }
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }

 private:
  void start_inits(std::span<const NodeNetwork> networks, const FleetOptions& options);

  Fabric fabric_;
  std::vector<Node> nodes_;
};

/// Open files that a fleet of `nodes` needs in the orchestrator, its children's sockets included.
[[nodiscard]] constexpr std::uint64_t open_files_for(std::size_t nodes) noexcept {
  // Per node: pidfd, control socket, network namespace, TAP, mon0, capture; agent's socket, log and
  // two memories.
  return 10 * nodes + 256;
}

}  // namespace cuscus::node
