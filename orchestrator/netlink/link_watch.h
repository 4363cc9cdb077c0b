#pragma once

#include <netlink/socket.h>

#include <memory>
#include <string>
#include <vector>

#include "common/posix/network_namespace.h"

namespace cuscus::netlink {

/// Tells when links of a network namespace gain or lose their carrier. A veth's is its other end's
/// being up.
class LinkWatch {
 public:
  struct Change {
    std::string name;
    bool has_carrier{};  ///< False also of a link that has gone.
  };

  /// From now on. @throws std::runtime_error when the kernel gives no socket.
  [[nodiscard]] static LinkWatch in(const posix::NetworkNamespace& where);

  /// What the kernel has told since the last call, oldest first; links that changed otherwise are
  /// among them. Never waits. What the socket had no room for is not there.
  [[nodiscard]] std::vector<Change> take();

  /// For poll(): readable when take() has something.
  [[nodiscard]] int fd() const noexcept { return ::nl_socket_get_fd(socket_.get()); }

 private:
  struct Free {
    void operator()(nl_sock* socket) const noexcept { ::nl_socket_free(socket); }
  };

  LinkWatch();

  std::unique_ptr<nl_sock, Free> socket_;
};

}  // namespace cuscus::netlink
