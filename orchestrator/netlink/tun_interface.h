#pragma once

#include <string>

#include "common/posix/unique_fd.h"

namespace cuscus::netlink {

/// Makes a persistent interface of the TUN driver in the calling thread's namespace. `flags`: of
/// TUNSETIFF, such as IFF_TAP. The descriptor is non-blocking.
/// @throws std::invalid_argument, std::system_error
[[nodiscard]] posix::UniqueFd create_tun_interface(const std::string& name, int flags);

}  // namespace cuscus::netlink
