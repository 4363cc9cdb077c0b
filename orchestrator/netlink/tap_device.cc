#include "orchestrator/netlink/tap_device.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "common/posix/check.h"

namespace cuscus::netlink {

TapDevice TapDevice::create_in(const posix::NetworkNamespace& where, const std::string& name) {
  return where.run([&] { return create(name); });
}

TapDevice TapDevice::create(const std::string& name) {
  if (name.empty() || name.size() >= IFNAMSIZ) {
    throw std::invalid_argument{"'" + name + "' is no interface name"};
  }
  posix::UniqueFd fd{
      posix::check("open /dev/net/tun", ::open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK))};
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::copy(name.begin(), name.end(), std::begin(request.ifr_name));
  posix::check("TUNSETIFF", ::ioctl(fd.get(), TUNSETIFF, &request));
  posix::check("TUNSETPERSIST", ::ioctl(fd.get(), TUNSETPERSIST, 1UL));
  return {std::move(fd), name};
}

}  // namespace cuscus::netlink
