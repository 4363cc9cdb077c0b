#include "orchestrator/netlink/monitor_device.h"

#include <linux/if_arp.h>
#include <linux/if_tun.h>
#include <sys/ioctl.h>

#include "common/posix/check.h"
#include "orchestrator/netlink/tun_interface.h"

namespace cuscus::netlink {

MonitorDevice MonitorDevice::create(const std::string& name) {
  posix::UniqueFd fd = create_tun_interface(name, IFF_TUN);
  posix::check("TUNSETLINK", ::ioctl(fd.get(), TUNSETLINK,
                                     static_cast<unsigned long>(ARPHRD_IEEE80211_RADIOTAP)));
  return MonitorDevice{std::move(fd)};
}

}  // namespace cuscus::netlink
