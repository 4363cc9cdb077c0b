#pragma once

#include <string>

namespace cuscus::init {

/// What makes a node of a set of fresh namespaces.
struct NodeSetup {
  std::string host_name;
  std::string hosts_text;  ///< /etc/hosts of the node; empty: the host's own.
  bool ipv6{false};
};

/// Prepares the namespaces that the calling process was cloned into: its own view of processes
/// (/proc), of devices (/sys, read-only), private /run and /dev/shm, its host name, its host table,
/// quiet network defaults, loopback. Nothing of it is visible outside.
/// @throws std::system_error naming what could not be done.
void set_up_node(const NodeSetup& setup);

}  // namespace cuscus::init
