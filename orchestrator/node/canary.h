#pragma once

#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "common/posix/network_namespace.h"
#include "common/posix/unique_fd.h"
#include "common/statistics/log2_histogram.h"
#include "orchestrator/netlink/route_socket.h"
#include "orchestrator/netlink/tap_device.h"
#include "orchestrator/node/fabric.h"
#include "orchestrator/node/node_links.h"

namespace cuscus::node {

/// What a canary has seen.
struct CanaryTally {
  std::uint64_t sent{0};
  std::uint64_t lost{0};           ///< Not seen within Canary::kPatience.
  statistics::Log2Histogram late;  ///< Seen this much later than sent and the link's delay.
};

/// Two hidden namespaces, attached to netsim as nodes are, and a link of fixed delay between them.
///
/// An ordinary thread sends a datagram from one to the other every kPeriod and looks when it wakes
/// up with it. Whatever that is later than the link says is the host's doing: from sendto() to the
/// emulator, the emulator's own lateness, the write, and the receiver's wake-up, which no other
/// measure sees. No node knows of it, and nothing of it is on the air.
class Canary {
 public:
  /// That of a beacon of 100 B on an idle air at 6 Mb/s: DIFS 50 us, 250 us (docs/models/mac.md).
  static constexpr std::chrono::nanoseconds kDelay{300'000};
  /// Not a multiple of any usual period of programs, so that it meets all their phases in turn.
  static constexpr std::chrono::milliseconds kPeriod{97};
  /// What comes later still makes a run INVALID (docs/fidelity.md).
  static constexpr std::chrono::milliseconds kPatience{500};

  /// Its ends are `first_index` and the next, behind all nodes.
  /// Of `surroundings` its neighbours are its own.
  Canary(const Fabric& fabric, std::uint32_t first_index, Attachment attachment,
         Surroundings surroundings);
  Canary(const Canary&) = delete;
  Canary& operator=(const Canary&) = delete;
  Canary(Canary&&) = delete;
  Canary& operator=(Canary&&) = delete;
  ~Canary() = default;

  /// Where netsim reads and writes the frames of end 0 or 1.
  [[nodiscard]] int tap_fd(std::size_t end) const { return ends_.at(end).tap.fd(); }

  /// Sends from now on, until stop().
  void start();
  /// Waits for what is under way. Nothing when it was not started.
  void stop();
  /// Valid when it does not send.
  [[nodiscard]] const CanaryTally& tally() const { return tally_; }

 private:
  struct End {
    posix::NetworkNamespace space;
    netlink::TapDevice tap;
    posix::UniqueFd socket;
  };

  [[nodiscard]] static End make_end(const Fabric& fabric, netlink::RouteSocket& fabric_routes,
                                    const NodeNetwork& network, const Surroundings& surroundings);
  void sing(const std::stop_token& stopped);
  void probe();

  std::vector<End> ends_;
  CanaryTally tally_;
  std::jthread singer_;
};

}  // namespace cuscus::node
