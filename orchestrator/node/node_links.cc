#include "orchestrator/node/node_links.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "orchestrator/netlink/offloads.h"
#include "orchestrator/netlink/receive_steering.h"

namespace cuscus::node {
namespace {

std::string link_name(const char* prefix, const NodeNetwork& network) {
  return prefix + std::to_string(network.index);
}

netlink::TapDevice build_bridged(const NodeNetwork& network, const posix::NetworkNamespace& where,
                                 const Fabric& fabric, netlink::RouteSocket& fabric_routes) {
  const std::string bridge = link_name("br", network);
  const std::string tap = link_name("tap", network);
  fabric_routes.create_bridge(bridge, network.mtu_bytes);
  const std::uint32_t bridge_index = fabric_routes.index_of(bridge);
  auto device = netlink::TapDevice::create_in(fabric.network_namespace(), tap);
  fabric_routes.change_link(tap, {.mtu_bytes = network.mtu_bytes,
                                  .queue_frames = network.queue_frames,
                                  .master_index = bridge_index,
                                  .up = true});
  fabric_routes.create_veth({.name = link_name("veth", network),
                             .peer_name = kInterface,
                             .peer_mac = network.mac,
                             .mtu_bytes = network.mtu_bytes,
                             .queue_frames = network.queue_frames,
                             .master_index = bridge_index},
                            where);
  return device;
}

/// In the calling thread's namespace.
void steer(const std::string& tap, const NodeNetwork& network, const Surroundings& surroundings) {
  const auto processors = surroundings.receive_processors;
  if (!processors.empty()) {
    // One per node, so that its frames keep their order.
    netlink::steer_receiving(tap, processors.subspan(network.index % processors.size(), 1));
  }
}

/// In the calling thread's namespace.
netlink::TapDevice build_direct(const NodeNetwork& network, netlink::RouteSocket& routes) {
  auto device = netlink::TapDevice::create(kInterface);
  routes.change_link(
      kInterface,
      {.mac = network.mac, .mtu_bytes = network.mtu_bytes, .queue_frames = network.queue_frames});
  return device;
}

/// Of the calling thread's namespace.
void configure_interface(const NodeNetwork& network, netlink::RouteSocket& routes,
                         const Surroundings& surroundings) {
  const std::uint32_t index = routes.index_of(kInterface);
  netlink::disable_offloads(kInterface);
  if (surroundings.send_stamps != nullptr) {
    surroundings.send_stamps->attach(routes, index, network.index);
  }
  routes.change_link(kInterface, {.up = true});
  routes.add_address(index, network.address);
  // Programs that announce themselves to everybody, or to a group, have no default route to do so.
  routes.add_link_route(index, {.address = {255, 255, 255, 255}, .length = 32});
  routes.add_link_route(index, {.address = {224, 0, 0, 0}, .length = 4});
  std::vector<netlink::Neighbour> others;
  std::ranges::copy_if(surroundings.neighbours, std::back_inserter(others),
                       [&](const netlink::Neighbour& neighbour) {
                         return neighbour.address != network.address.address;
                       });
  routes.add_neighbours(index, others);
}

}  // namespace

netlink::TapDevice build_links(const NodeNetwork& network, const posix::NetworkNamespace& where,
                               const Fabric& fabric, netlink::RouteSocket& fabric_routes,
                               const Surroundings& surroundings) {
  try {
    std::optional<netlink::TapDevice> tap;
    if (network.attachment == Attachment::kBridge) {
      tap = build_bridged(network, where, fabric, fabric_routes);
      fabric.network_namespace().run(
          [&] { steer(link_name("tap", network), network, surroundings); });
    }
    where.run([&] {
      netlink::RouteSocket routes;
      if (network.attachment == Attachment::kDirect) {
        tap = build_direct(network, routes);
        steer(kInterface, network, surroundings);
      }
      configure_interface(network, routes, surroundings);
    });
    return std::move(*tap);
  } catch (const std::exception& error) {
    throw std::runtime_error{network.name + ": " + error.what()};
  }
}

netlink::MonitorDevice build_monitor(const NodeNetwork& network,
                                     const posix::NetworkNamespace& where) {
  try {
    std::optional<netlink::MonitorDevice> monitor;
    where.run([&] {
      monitor = netlink::MonitorDevice::create(kMonitorInterface);
      netlink::RouteSocket{}.change_link(kMonitorInterface,
                                         {.queue_frames = 1, .up = network.monitor});
    });
    return std::move(*monitor);
  } catch (const std::exception& error) {
    throw std::runtime_error{network.name + ": " + error.what()};
  }
}

netlink::LinkCounters tap_counters(const NodeNetwork& network, const posix::NetworkNamespace& where,
                                   const Fabric& fabric) {
  return network.attachment == Attachment::kBridge
             ? netlink::RouteSocket::in(fabric.network_namespace())
                   .counters_of(link_name("tap", network))
             : netlink::RouteSocket::in(where).counters_of(kInterface);
}

}  // namespace cuscus::node
