#pragma once

#include <span>
#include <string>

#include "orchestrator/netlink/addresses.h"

namespace cuscus::node {

/// A name, and where it is.
struct HostEntry {
  std::string name;
  netlink::Ipv4Address address{};
};

/// The /etc/hosts of every node (hosts(5)): localhost, by IPv4 since nodes have IPv6 only where the
/// scenario asks, then the fleet.
[[nodiscard]] std::string hosts_file(std::span<const HostEntry> entries);

}  // namespace cuscus::node
