#include "orchestrator/node/rights.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <string>
#include <system_error>

#include "common/posix/capability_set.h"
#include "common/posix/check.h"
#include "common/posix/network_namespace.h"
#include "common/posix/unique_fd.h"

namespace cuscus::node {
namespace {

void write_file(const char* path, const std::string& text) {
  const std::string attempt = std::string{"write "} + path;
  const posix::UniqueFd file{posix::check(attempt, ::open(path, O_WRONLY | O_CLOEXEC))};
  posix::check(attempt, ::write(file.get(), text.data(), text.size()));
}

void enter_user_namespace() {
  const std::string uid = std::to_string(::geteuid());
  const std::string gid = std::to_string(::getegid());
  posix::check("unshare(CLONE_NEWUSER)", ::unshare(CLONE_NEWUSER));
  // user_namespaces(7): a gid may be mapped without rights only once setgroups() is given up.
  write_file("/proc/self/setgroups", "deny");
  write_file("/proc/self/uid_map", "0 " + uid + " 1");
  write_file("/proc/self/gid_map", "0 " + gid + " 1");
  // Some systems allow the namespace and then refuse everything that it is good for.
  static_cast<void>(posix::NetworkNamespace::create());
}

}  // namespace

std::variant<Rights, netlink::NotAvailable> acquire_rights() {
  if (::geteuid() == 0 && posix::has_capability(CAP_SYS_ADMIN) &&
      posix::has_capability(CAP_NET_ADMIN)) {
    return Rights::kRoot;
  }
  const bool container = ::geteuid() == 0;
  const std::string who = container ? "root without CAP_SYS_ADMIN and CAP_NET_ADMIN" : "not root";
  const std::string remedy = container ? std::string{kContainerRemedy} : "run with sudo";
  if (const posix::UniqueFd tun{::open("/dev/net/tun", O_RDWR | O_CLOEXEC)}; !tun) {
    return netlink::NotAvailable{who + ", and /dev/net/tun cannot be opened without (" +
                                 std::generic_category().message(errno) + "): " + remedy +
                                 ", or make the device accessible (chmod 0666 /dev/net/tun)"};
  }
  try {
    enter_user_namespace();
  } catch (const std::exception& error) {
    return netlink::NotAvailable{
        who + ", and user namespaces do not work for this user (" + error.what() + "): " + remedy +
        ", or allow them (sysctl kernel.unprivileged_userns_clone=1, "
        "kernel.apparmor_restrict_unprivileged_userns=0, user.max_user_namespaces)"};
  }
  return Rights::kUserNamespace;
}

}  // namespace cuscus::node
