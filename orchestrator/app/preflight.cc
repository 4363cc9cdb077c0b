#include "orchestrator/app/preflight.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <variant>

#include "common/posix/check.h"
#include "common/posix/open_file_limit.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/node/fleet.h"

namespace cuscus::orchestrator {

node::Rights acquire_run_rights() {
  auto rights = node::acquire_rights();
  if (const auto* const missing = std::get_if<netlink::NotAvailable>(&rights)) {
    throw UsageError{"cannot make namespaces: " + missing->reason};
  }
  return std::get<node::Rights>(rights);
}

void check_tun() {
  const posix::UniqueFd tun{::open("/dev/net/tun", O_RDWR | O_CLOEXEC)};
  if (!tun) {
    throw UsageError{fmt::format(
        "/dev/net/tun cannot be opened: {}. Load it with 'modprobe tun'; in a container, {}",
        std::strerror(errno),  // NOLINT(concurrency-mt-unsafe): one thread
        node::kContainerRemedy)};
  }
}

std::filesystem::path check_own_programs() {
  auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* const program : {"cuscus-init", "cuscus-netsim", "cuscus-world", "cuscus-camera",
                                    "cuscus-agent", "cuscus-gcs"}) {
    if (::access((folder / program).c_str(), X_OK) != 0) {
      throw UsageError{
          fmt::format("{} is missing beside {}", program, (folder / "cuscus").native())};
    }
  }
  return folder;
}

void check_open_files(const Plan& plan) {
  const std::uint64_t needed = node::open_files_for(plan.nodes.size());
  if (const auto allowed = posix::raise_open_file_limit(needed); allowed < needed) {
    throw UsageError{fmt::format("{} nodes need {} open files, {} are allowed: 'ulimit -n {}'",
                                 plan.nodes.size(), needed, allowed, needed)};
  }
}

posix::UniqueFd listen_for_page(std::uint16_t port) {
  posix::UniqueFd socket{
      posix::check("socket", ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0))};
  const int on = 1;
  posix::check("SO_REUSEADDR",
               ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.get(), SOMAXCONN) != 0) {
    throw UsageError{
        fmt::format("the page cannot listen on 127.0.0.1:{}: {}. Choose another port with "
                    "'--set ground_station.page.port=PORT' (1024 ... 65535), or '--no-page'",
                    port, std::strerror(errno))};  // NOLINT(concurrency-mt-unsafe): one thread
  }
  return socket;
}

}  // namespace cuscus::orchestrator
