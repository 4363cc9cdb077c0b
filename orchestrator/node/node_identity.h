#pragma once

#include <sys/types.h>

#include <cstdint>

namespace cuscus::node {

/// First uid and gid that the testbed gives to processes of its own. At the end of the range that
/// distributions keep for ordinary accounts (1000 to 59999, Debian Policy 9.2.2), which they fill
/// from its beginning; below 65536, so that the uid map of an outer container has it; and outside
/// those of systemd's dynamic users (61184 to 65519).
constexpr uid_t kUnprivilegedBase = 58000;

/// Processes that are no node's: netsim, the world, and so on.
constexpr uid_t kServices = 16;

constexpr std::uint32_t kMaximumNodes = 1000;

/// The uid, and gid, of the n-th service; n < kServices.
[[nodiscard]] constexpr uid_t service_uid(std::uint32_t service) noexcept {
  return kUnprivilegedBase + service;
}

/// The uid, and gid, of what flies node `index`. Nodes differ, so that a file or a key of one is
/// not another's.
[[nodiscard]] constexpr uid_t node_uid(std::uint32_t index) noexcept {
  return kUnprivilegedBase + kServices + index;
}

}  // namespace cuscus::node
