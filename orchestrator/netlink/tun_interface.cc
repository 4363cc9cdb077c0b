#include "orchestrator/netlink/tun_interface.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "common/posix/check.h"

namespace cuscus::netlink {

posix::UniqueFd create_tun_interface(const std::string& name, int flags) {
  if (name.empty() || name.size() >= IFNAMSIZ) {
    throw std::invalid_argument{"'" + name + "' is no interface name"};
  }
  posix::UniqueFd fd{
      posix::check("open /dev/net/tun", ::open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK))};
  ifreq request{};
  request.ifr_flags = static_cast<short>(flags);
  std::copy(name.begin(), name.end(), std::begin(request.ifr_name));
  posix::check("TUNSETIFF", ::ioctl(fd.get(), TUNSETIFF, &request));
  posix::check("TUNSETPERSIST", ::ioctl(fd.get(), TUNSETPERSIST, 1UL));
  return fd;
}

}  // namespace cuscus::netlink
