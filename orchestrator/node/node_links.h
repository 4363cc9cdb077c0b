#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/posix/network_namespace.h"
#include "orchestrator/netlink/addresses.h"
#include "orchestrator/netlink/monitor_device.h"
#include "orchestrator/netlink/route_socket.h"
#include "orchestrator/netlink/send_stamps.h"
#include "orchestrator/netlink/tap_device.h"
#include "orchestrator/node/fabric.h"

namespace cuscus::node {

/// How a node's wlan0 is connected to netsim.
enum class Attachment {
  kBridge,  ///< Fabric: TAP - bridge - veth; node: wlan0 is the other end. Others can join.
  kDirect,  ///< The TAP itself is wlan0: half the delay, two thirds of the CPU.
};

/// The interface that a node's programs use.
inline constexpr const char* kInterface = "wlan0";

/// Where they can see what its radio sends and receives.
inline constexpr const char* kMonitorInterface = "mon0";

/// One node's place in the network.
struct NodeNetwork {
  std::uint32_t index{};  ///< 0 to kMaximumNodes - 1; names the links in the fabric.
  std::string name;       ///< Host name, such as "uav3".
  netlink::MacAddress mac{};
  netlink::Ipv4Prefix address{};
  std::uint32_t mtu_bytes{1500};
  std::uint32_t queue_frames{
      1000};  ///< txqueuelen: beyond it the TAP drops what netsim is late for.
  Attachment attachment{Attachment::kBridge};
  bool ipv6{false};     ///< Off: no frame leaves that nobody sent.
  bool monitor{false};  ///< mon0 is up from the start.
};

/// What nodes have in common besides the fabric.
struct Surroundings {
  std::span<const netlink::Neighbour> neighbours{};  ///< Permanent ones; empty: nodes use ARP.
  const netlink::SendStampRing* send_stamps{};       ///< Null: no stamps.
  /// Where the kernel works on what netsim has written; empty: where netsim writes.
  std::span<const int> receive_processors{};
};

/// Builds wlan0 in the node's namespace `where` and what connects it to netsim; its TAP.
[[nodiscard]] netlink::TapDevice build_links(const NodeNetwork& network,
                                             const posix::NetworkNamespace& where,
                                             const Fabric& fabric,
                                             netlink::RouteSocket& fabric_routes,
                                             const Surroundings& surroundings);

/// Builds mon0 there. What a program sends to it goes nowhere: one frame waits, others are dropped.
[[nodiscard]] netlink::MonitorDevice build_monitor(const NodeNetwork& network,
                                                   const posix::NetworkNamespace& where);

/// What wlan0 and, in the fabric, the TAP have counted and dropped.
[[nodiscard]] netlink::LinkCounters tap_counters(const NodeNetwork& network,
                                                 const posix::NetworkNamespace& where,
                                                 const Fabric& fabric);

}  // namespace cuscus::node
