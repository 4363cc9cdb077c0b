#include "orchestrator/node/environment_checks.h"

#include <sched.h>
#include <sys/utsname.h>

#include <array>
#include <exception>
#include <filesystem>
#include <functional>
#include <thread>
#include <variant>

#include "common/posix/network_namespace.h"
#include "common/posix/open_file_limit.h"
#include "common/posix/scheduling.h"
#include "orchestrator/netlink/route_socket.h"
#include "orchestrator/netlink/send_stamps.h"
#include "orchestrator/netlink/tap_device.h"
#include "orchestrator/node/fleet.h"
#include "orchestrator/node/rights.h"

namespace cuscus::node {
namespace {

using Result = EnvironmentCheck::Result;

EnvironmentCheck check_kernel() {
  // pidfds and clone3() are older; the last that we need is close_range(CLOSE_RANGE_CLOEXEC).
  constexpr KernelVersion kNeeded{.major = 5, .minor = 11};
  utsname system{};
  ::uname(&system);
  const std::string release = static_cast<const char*>(system.release);
  if (parse_kernel_version(release) < kNeeded) {
    return {"kernel", Result::kFail, "Linux " + release, "Linux 5.11 or newer is needed"};
  }
  return {"kernel", Result::kOk, "Linux " + release, ""};
}

EnvironmentCheck check_rights() {
  const auto rights = acquire_rights();
  if (const auto* const missing = std::get_if<netlink::NotAvailable>(&rights)) {
    return {"rights", Result::kFail, missing->reason, ""};
  }
  if (std::get<Rights>(rights) == Rights::kUserNamespace) {
    return {"rights", Result::kWarning,
            "root of a user namespace: one uid for all programs, no SCHED_FIFO, no send stamps",
            "run with sudo for exact timing"};
  }
  return {"rights", Result::kOk, "root", ""};
}

/// Tries `body`, which returns what to say when it works.
EnvironmentCheck attempt(const std::string& name, const std::string& remedy,
                         const std::function<std::string()>& body) {
  try {
    return {name, Result::kOk, body(), ""};
  } catch (const std::exception& error) {
    return {name, Result::kFail, error.what(), remedy};
  }
}

EnvironmentCheck check_tap() {
  return attempt("TAP devices", "load the module 'tun', and give a container /dev/net/tun", [] {
    static_cast<void>(
        netlink::TapDevice::create_in(posix::NetworkNamespace::create(), "tap-scratch"));
    return std::string{"/dev/net/tun works"};
  });
}

EnvironmentCheck check_links() {
  auto check = attempt("bridge and veth", "load the modules 'bridge' and 'veth'", [] {
    const auto fabric = posix::NetworkNamespace::create();
    const auto inner = posix::NetworkNamespace::create();
    auto routes = netlink::RouteSocket::in(fabric);
    routes.create_bridge("br-scratch", 1500);
    routes.create_veth({.name = "veth-scratch",
                        .peer_name = kInterface,
                        .peer_mac = {2, 0, 0, 0, 0, 1},
                        .master_index = routes.index_of("br-scratch")},
                       inner);
    return std::string{"both can be made"};
  });
  if (check.result == Result::kFail) {
    check.result = Result::kWarning;
    check.remedy += "; until then only \"direct\" attachment works";
  }
  return check;
}

EnvironmentCheck check_node() {
  return attempt("a node", "in a container: " + std::string{kContainerRemedy}, [] {
    const std::array networks{NodeNetwork{.name = "doctor",
                                          .mac = {2, 0, 0, 0, 0, 1},
                                          .address = {.address = {10, 0, 0, 1}, .length = 24},
                                          .attachment = Attachment::kDirect}};
    const Fleet fleet{networks, {}};
    return std::string{"can be built"};
  });
}

EnvironmentCheck check_send_stamps() {
  const auto ring = netlink::SendStampRing::create(64 * 1024);
  if (const auto* const missing = std::get_if<netlink::NotAvailable>(&ring)) {
    return {"send stamps", Result::kWarning, missing->reason,
            "run as root on a kernel with CONFIG_BPF_SYSCALL, CONFIG_NET_CLS_BPF and "
            "CONFIG_NET_SCH_INGRESS; without, frames are stamped when they are read"};
  }
  return {"send stamps", Result::kOk, "a BPF program at tc egress works", ""};
}

EnvironmentCheck check_realtime() {
  bool granted = false;
  // On a thread of its own: the caller's scheduling stays.
  std::jthread{[&] { granted = posix::try_realtime_scheduling(1); }}.join();
  if (granted) {
    return {"SCHED_FIFO", Result::kOk, "can be had", ""};
  }
  return {"SCHED_FIFO", Result::kWarning, "refused: frames will be late whenever the host is busy",
          "run as root, or raise RLIMIT_RTPRIO (ulimit -r) to 60"};
}

EnvironmentCheck check_open_files(std::size_t nodes) {
  const std::uint64_t needed = open_files_for(nodes);
  const std::uint64_t got = posix::raise_open_file_limit(needed);
  const std::string text = std::to_string(nodes) + " nodes need " + std::to_string(needed) +
                           " open files, the limit is " + std::to_string(got);
  if (got < needed) {
    return {"open files", Result::kFail, text,
            "raise the hard limit (ulimit -Hn, LimitNOFILE=, /etc/security/limits.conf)"};
  }
  return {"open files", Result::kOk, text, ""};
}

EnvironmentCheck check_cores() {
  constexpr int kComfortable = 4;
  cpu_set_t set;
  CPU_ZERO(&set);
  ::sched_getaffinity(0, sizeof set, &set);
  const int cores = CPU_COUNT(&set);
  const std::string text = std::to_string(cores) + (cores == 1 ? " core" : " cores");
  if (cores < kComfortable) {
    return {"cores", Result::kWarning, text + ": netsim, the world and the programs share them",
            "give it four or more for exact timing"};
  }
  return {"cores", Result::kOk, text, ""};
}

EnvironmentCheck check_bridge_filter() {
  // The host's: scratch namespaces have the same keys.
  const bool loaded = std::filesystem::exists("/proc/sys/net/bridge/bridge-nf-call-iptables");
  return {"br_netfilter", Result::kOk, loaded ? "loaded; switched off in the fabric" : "not loaded",
          ""};
}

EnvironmentCheck check_ipv6() {
  const bool there = std::filesystem::exists("/proc/sys/net/ipv6/conf/all/disable_ipv6");
  return {"IPv6", Result::kOk,
          there ? "present; nodes have it only where the scenario asks" : "not in this kernel", ""};
}

}  // namespace

std::vector<EnvironmentCheck> check_environment(std::size_t nodes) {
  std::vector<EnvironmentCheck> checks{check_kernel(), check_rights()};
  if (checks.back().result != Result::kFail) {
    checks.push_back(check_tap());
    checks.push_back(check_links());
    checks.push_back(check_node());
    checks.push_back(check_send_stamps());
  }
  checks.push_back(check_realtime());
  checks.push_back(check_open_files(nodes));
  checks.push_back(check_cores());
  checks.push_back(check_bridge_filter());
  checks.push_back(check_ipv6());
  return checks;
}

}  // namespace cuscus::node
