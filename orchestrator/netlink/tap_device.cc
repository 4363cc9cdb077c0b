#include "orchestrator/netlink/tap_device.h"

#include <linux/if_tun.h>

#include "orchestrator/netlink/tun_interface.h"

namespace cuscus::netlink {

TapDevice TapDevice::create_in(const posix::NetworkNamespace& where, const std::string& name) {
  return where.run([&] { return create(name); });
}

TapDevice TapDevice::create(const std::string& name) {
  return {create_tun_interface(name, IFF_TAP | IFF_NO_PI), name};
}

}  // namespace cuscus::netlink
