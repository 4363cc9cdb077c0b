#pragma once

#include <string>
#include <utility>

#include "common/posix/network_namespace.h"
#include "common/posix/unique_fd.h"

namespace cuscus::netlink {

/// A TAP interface inside a namespace, and the descriptor from which its frames are read: one
/// Ethernet frame per read() or write(), non-blocking, without a packet-information header.
///
/// The interface is persistent: closing the descriptor leaves it, which takes no time (closing a
/// hundred others one by one takes 25 ms each), and it goes with its unnamed namespace.
class TapDevice {
 public:
  /// @throws std::system_error without /dev/net/tun or CAP_NET_ADMIN over the namespace.
  [[nodiscard]] static TapDevice create_in(const posix::NetworkNamespace& where,
                                           const std::string& name);
  /// In the calling thread's namespace.
  [[nodiscard]] static TapDevice create(const std::string& name);

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] posix::UniqueFd release() && { return std::move(fd_); }

 private:
  TapDevice(posix::UniqueFd fd, std::string name) : fd_{std::move(fd)}, name_{std::move(name)} {}

  posix::UniqueFd fd_;
  std::string name_;
};

}  // namespace cuscus::netlink
