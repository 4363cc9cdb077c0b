#pragma once

#include <string>
#include <utility>

#include "common/posix/unique_fd.h"

namespace cuscus::netlink {

/// A monitor interface: packets written to its descriptor, each a radiotap header and an 802.11
/// frame behind the 4 octets of struct tun_pi, are seen by those who listen on it. It is down, and
/// refuses them with EIO, until somebody sets it up.
///
/// It is a TUN interface with the link type of radiotap, so that programs on libpcap know what they
/// read; it has no address and is no way out. Persistent, as a TapDevice is.
class MonitorDevice {
 public:
  /// In the calling thread's namespace.
  /// @throws std::system_error without /dev/net/tun or CAP_NET_ADMIN over the namespace.
  [[nodiscard]] static MonitorDevice create(const std::string& name);

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

 private:
  explicit MonitorDevice(posix::UniqueFd fd) : fd_{std::move(fd)} {}

  posix::UniqueFd fd_;
};

}  // namespace cuscus::netlink
