#pragma once

#include <string_view>
#include <variant>

#include "orchestrator/netlink/send_stamps.h"

namespace cuscus::node {

/// What a container needs for runs.
inline constexpr std::string_view kContainerRemedy =
    "start it with '--privileged', or with '--device /dev/net/tun --cap-add NET_ADMIN --cap-add "
    "SYS_ADMIN --security-opt systempaths=unconfined --security-opt apparmor=unconfined'";

/// By what right the calling process makes namespaces and links.
enum class Rights {
  kRoot,           ///< Root of the machine, or of a container with CAP_SYS_ADMIN and CAP_NET_ADMIN.
  kUserNamespace,  ///< Root of a user namespace of its own, in which only its own uid exists.
};

/// Takes what is to be had. An ordinary user's process moves into a new user namespace, in which
/// its uid and gid are 0; in there links and namespaces work as for root, but
///  - there is one uid: programs run as it (ChildIdentity{0, 0}), without capabilities, and are
///    kept apart by their namespaces alone;
///  - SCHED_FIFO and BPF stay the machine's, so that send stamps are not available;
///  - /dev/net/tun must be readable and writable for the user, as it is on most distributions.
/// Call before the first thread starts; once.
///
/// Returns why neither can be had, with the remedy.
[[nodiscard]] std::variant<Rights, netlink::NotAvailable> acquire_rights();

}  // namespace cuscus::node
