#include "orchestrator/init/node_setup.h"

#include <fcntl.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/posix/check.h"
#include "common/posix/kernel_settings.h"
#include "common/posix/unique_fd.h"

namespace cuscus::init {
namespace {

using posix::check;
using posix::UniqueFd;
using posix::write_sysctl;

constexpr unsigned long kNoSurprises = MS_NOSUID | MS_NODEV | MS_NOEXEC;

void mount_file_systems() {
  // First, or every mount below would appear on the host as well.
  check("make mounts private", ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr));
  check("mount /proc", ::mount("proc", "/proc", "proc", kNoSurprises, nullptr));
  check("mount /sys", ::mount("sysfs", "/sys", "sysfs", kNoSurprises | MS_RDONLY, nullptr));
  check("mount /run",
        ::mount("tmpfs", "/run", "tmpfs", MS_NOSUID | MS_NODEV, "mode=0755,size=64m"));
  // POSIX shared memory would be common to all nodes otherwise: no IPC namespace covers it.
  if (::mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, "mode=1777,size=64m") != 0 &&
      errno != ENOENT) {
    posix::throw_errno("mount /dev/shm");
  }
}

void install_hosts(const std::string& text) {
  constexpr const char* kFile = "/run/hosts";
  {
    const UniqueFd file{
        check("create /run/hosts", ::open(kFile, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644))};
    for (std::string_view rest = text; !rest.empty();) {
      rest.remove_prefix(static_cast<std::size_t>(
          check("write /run/hosts", ::write(file.get(), rest.data(), rest.size()))));
    }
    check("fchmod /run/hosts", ::fchmod(file.get(), 0644));
  }
  // A system without /etc/hosts has nothing to mount it on; names then do not resolve.
  if (::mount(kFile, "/etc/hosts", nullptr, MS_BIND, nullptr) != 0 && errno != ENOENT) {
    posix::throw_errno("mount /etc/hosts");
  }
}

/// A namespace copies some defaults from the host, whose administrator had other things in mind.
void set_network_defaults(bool ipv6) {
  for (const std::string scope : {"all", "default"}) {
    // Router solicitations, MLD reports and duplicate address detection would occupy the air.
    write_sysctl("net/ipv6/conf/" + scope + "/disable_ipv6", ipv6 ? "0" : "1");
    write_sysctl("net/ipv6/conf/" + scope + "/accept_ra", "0");
    write_sysctl("net/ipv6/conf/" + scope + "/router_solicitations", "0");
    write_sysctl("net/ipv6/conf/" + scope + "/accept_dad", "0");
    write_sysctl("net/ipv4/conf/" + scope + "/rp_filter", "0");
    write_sysctl("net/ipv4/conf/" + scope + "/arp_notify", "0");
    write_sysctl("net/ipv4/conf/" + scope + "/send_redirects", "0");
  }
  write_sysctl("net/ipv4/ip_forward", "0");
  // ping without rights. Groups that the user namespace does not map are refused.
  for (const std::string_view groups : {"0 2147483647", "0 65535", "0 0"}) {
    try {
      write_sysctl("net/ipv4/ping_group_range", groups);
      break;
    } catch (const std::system_error&) {
      continue;
    }
  }
}

void bring_loopback_up() {
  const UniqueFd socket{
      check("open a socket for loopback", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  ifreq request{};
  request.ifr_name[0] = 'l';
  request.ifr_name[1] = 'o';
  request.ifr_flags = IFF_UP;
  check("bring loopback up", ::ioctl(socket.get(), SIOCSIFFLAGS, &request));
}

}  // namespace

void set_up_node(const NodeSetup& setup) {
  mount_file_systems();
  check("set the host name", ::sethostname(setup.host_name.data(), setup.host_name.size()));
  if (!setup.hosts_text.empty()) {
    install_hosts(setup.hosts_text);
  }
  set_network_defaults(setup.ipv6);
  bring_loopback_up();
}

}  // namespace cuscus::init
