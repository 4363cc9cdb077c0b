#include "orchestrator/netlink/offloads.h"

#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "common/posix/check.h"
#include "common/posix/unique_fd.h"

namespace cuscus::netlink {
namespace {

struct Offload {
  std::uint32_t get;
  std::uint32_t set;
};

// Checksums first: without them the kernel drops segmentation by itself.
constexpr std::array kOffloads{
    Offload{ETHTOOL_GTXCSUM, ETHTOOL_STXCSUM}, Offload{ETHTOOL_GTSO, ETHTOOL_STSO},
    Offload{ETHTOOL_GGSO, ETHTOOL_SGSO}, Offload{ETHTOOL_GGRO, ETHTOOL_SGRO},
    Offload{ETHTOOL_GRXCSUM, ETHTOOL_SRXCSUM}};

class EthtoolLink {
 public:
  explicit EthtoolLink(const std::string& name)
      : name_{name},
        socket_{posix::check("open a socket for ethtool",
                             ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))} {
    if (name.size() >= IFNAMSIZ) {
      throw std::invalid_argument{"'" + name + "' is too long for an interface's name"};
    }
  }

  [[nodiscard]] bool is_on(std::uint32_t command) const { return call(command, 0) != 0; }
  void turn_off(std::uint32_t command) const { static_cast<void>(call(command, 0)); }

 private:
  [[nodiscard]] std::uint32_t call(std::uint32_t command, std::uint32_t value) const {
    ethtool_value argument{.cmd = command, .data = value};
    ifreq request{};
    std::copy(name_.begin(), name_.end(), std::begin(request.ifr_name));
    request.ifr_data = reinterpret_cast<char*>(&argument);
    if (::ioctl(socket_.get(), SIOCETHTOOL, &request) != 0) {
      if (errno == EOPNOTSUPP) {
        return 0;
      }
      posix::throw_errno("ethtool on '" + name_ + "'");
    }
    return argument.data;
  }

  std::string name_;
  posix::UniqueFd socket_;
};

}  // namespace

void disable_offloads(const std::string& link_name) {
  const EthtoolLink link{link_name};
  for (const Offload& offload : kOffloads) {
    if (link.is_on(offload.get)) {
      link.turn_off(offload.set);
    }
  }
}

bool has_offloads(const std::string& link_name) {
  const EthtoolLink link{link_name};
  return link.is_on(ETHTOOL_GTXCSUM) || link.is_on(ETHTOOL_GTSO) || link.is_on(ETHTOOL_GGSO);
}

}  // namespace cuscus::netlink
