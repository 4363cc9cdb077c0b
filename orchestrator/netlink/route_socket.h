#pragma once

#include <netlink/socket.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/posix/network_namespace.h"
#include "orchestrator/netlink/addresses.h"
#include "orchestrator/netlink/route_message.h"

namespace cuscus::netlink {

/// What to change of a link; what is absent stays as it is.
struct LinkChange {
  std::optional<MacAddress> mac{};
  std::optional<std::uint32_t> mtu_bytes{};
  std::optional<std::uint32_t> queue_frames{};  ///< txqueuelen
  std::optional<std::uint32_t> master_index{};  ///< The bridge that it becomes a port of.
  std::optional<bool> up{};
};

/// A pair of interfaces, the second of which is born in another namespace, and is down there.
struct VethPair {
  std::string name;
  std::string peer_name;
  MacAddress peer_mac{};
  std::uint32_t mtu_bytes{1500};
  std::uint32_t queue_frames{1000};
  std::uint32_t master_index{};  ///< The bridge of the near end; 0: none.
};

/// What a link has counted since it was made.
struct LinkCounters {
  std::uint64_t sent_frames{};
  std::uint64_t received_frames{};
  std::uint64_t send_drops{};  ///< tx_dropped; of a TAP: frames that netsim was too slow to read.
  std::uint64_t receive_drops{};
};

/// The links, addresses, neighbours and filters of one network namespace (rtnetlink(7)).
///
/// The socket belongs to the namespace of the thread that made it, and may then be used from any
/// thread, by one at a time. Every verb waits for the kernel's answer and throws std::system_error
/// with the kernel's own explanation, where it gives one.
class RouteSocket {
 public:
  /// For the calling thread's namespace.
  RouteSocket();
  [[nodiscard]] static RouteSocket in(const posix::NetworkNamespace& where);

  /// A bridge that is up and only forwards: no spanning tree, no multicast snooping, no delay.
  void create_bridge(const std::string& name, std::uint32_t mtu_bytes);
  void create_veth(const VethPair& pair, const posix::NetworkNamespace& peer_namespace);
  void change_link(const std::string& name, const LinkChange& change);
  void delete_link(const std::string& name);

  [[nodiscard]] std::uint32_t index_of(const std::string& name);
  [[nodiscard]] LinkCounters counters_of(const std::string& name);

  void add_address(std::uint32_t link_index, const Ipv4Prefix& prefix);
  /// What is sent to `destination` leaves by the link, to be resolved there.
  void add_link_route(std::uint32_t link_index, const Ipv4Prefix& destination);
  /// Permanent neighbours, many in one system call. Their state never times out, so no ARP.
  void add_neighbours(std::uint32_t link_index, std::span<const Neighbour> neighbours);

  /// The hook for programs at a link's ingress and egress.
  void add_clsact(std::uint32_t link_index);
  /// Runs a loaded program on everything that leaves by the link, in direct-action mode.
  void add_egress_program(std::uint32_t link_index, int program_fd, const std::string& name);

 private:
  struct Free {
    void operator()(nl_sock* socket) const noexcept { ::nl_socket_free(socket); }
  };
  using OnReply = std::function<void(const nlmsghdr&)>;

  void send(std::span<const std::uint8_t> bytes, const std::string& attempt);
  /// Reads until the answer to `sequence`; throws on any error, of an earlier message too.
  void await_answer(std::uint32_t sequence, const std::string& attempt, const OnReply& on_reply);
  void transact(RouteMessage message, const std::string& attempt, const OnReply& on_reply = {});
  [[nodiscard]] int fd() const noexcept { return ::nl_socket_get_fd(socket_.get()); }

  std::unique_ptr<nl_sock, Free> socket_;
  std::uint32_t sequence_{0};
};

}  // namespace cuscus::netlink
