#include "orchestrator/netlink/route_socket.h"

#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netlink/errno.h>
#include <netlink/netlink.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "common/posix/check.h"

namespace cuscus::netlink {
namespace {

constexpr int kCreate = NLM_F_CREATE | NLM_F_EXCL;
constexpr std::size_t kAnswerBytes = std::size_t{32} * 1024;

/// Rounded up to netlink's alignment; the kernel's own macros mix signs.
constexpr std::size_t aligned(std::size_t size) { return (size + 3U) & ~std::size_t{3}; }
constexpr std::size_t kAttributeHeaderBytes = aligned(sizeof(nlattr));

ifinfomsg link_header(std::optional<bool> up) {
  ifinfomsg header{};
  header.ifi_family = AF_UNSPEC;
  if (up) {
    header.ifi_flags = *up ? IFF_UP : 0;
    header.ifi_change = IFF_UP;
  }
  return header;
}

/// The kernel's explanation in an error answer (NETLINK_EXT_ACK), or nothing.
std::string_view explanation_in(const nlmsghdr& answer, const nlmsgerr& error) {
  if ((answer.nlmsg_flags & NLM_F_ACK_TLVS) == 0) {
    return {};
  }
  std::size_t offset = 2 * sizeof(nlmsghdr) + sizeof(error.error);
  if ((answer.nlmsg_flags & NLM_F_CAPPED) == 0) {
    offset += aligned(error.msg.nlmsg_len) - sizeof(nlmsghdr);
  }
  const auto* const start = reinterpret_cast<const char*>(&answer);
  while (offset + sizeof(nlattr) <= answer.nlmsg_len) {
    nlattr attribute{};
    std::memcpy(&attribute, start + offset, sizeof attribute);
    if (attribute.nla_len <= kAttributeHeaderBytes ||
        offset + attribute.nla_len > answer.nlmsg_len) {
      return {};
    }
    if ((attribute.nla_type & NLA_TYPE_MASK) == NLMSGERR_ATTR_MSG) {
      return {start + offset + kAttributeHeaderBytes,
              attribute.nla_len - kAttributeHeaderBytes - 1U};
    }
    offset += aligned(attribute.nla_len);
  }
  return {};
}

/// Throws when `answer` reports an error.
void check_answer(const nlmsghdr& answer, const std::string& attempt) {
  if (answer.nlmsg_type != NLMSG_ERROR || answer.nlmsg_len < sizeof(nlmsghdr) + sizeof(nlmsgerr)) {
    return;
  }
  const auto& error = *static_cast<const nlmsgerr*>(::nlmsg_data(&answer));
  if (error.error != 0) {
    std::string text = attempt;
    if (const auto explanation = explanation_in(answer, error); !explanation.empty()) {
      text += " (" + std::string{explanation} + ")";
    }
    throw std::system_error{-error.error, std::system_category(), text};
  }
}

/// The payload of attribute `type` of an RTM_NEWLINK answer, or nothing.
std::span<const std::uint8_t> attribute_of(const nlmsghdr& answer, int type) {
  auto* const message = const_cast<nlmsghdr*>(&answer);
  const nlattr* const found = ::nlmsg_find_attr(message, static_cast<int>(sizeof(ifinfomsg)), type);
  if (found == nullptr) {
    return {};
  }
  return {static_cast<const std::uint8_t*>(::nla_data(found)),
          static_cast<std::size_t>(::nla_len(found))};
}

}  // namespace

RouteSocket::RouteSocket() : socket_{::nl_socket_alloc()} {
  if (socket_ == nullptr) {
    throw std::bad_alloc{};
  }
  if (const int error = ::nl_connect(socket_.get(), NETLINK_ROUTE); error < 0) {
    throw std::runtime_error{std::string{"open an rtnetlink socket: "} + ::nl_geterror(error)};
  }
  const int on = 1;
  posix::check("NETLINK_EXT_ACK", ::setsockopt(fd(), SOL_NETLINK, NETLINK_EXT_ACK, &on, sizeof on));
}

RouteSocket RouteSocket::in(const posix::NetworkNamespace& where) {
  return where.run([] { return RouteSocket{}; });
}

void RouteSocket::send(std::span<const std::uint8_t> bytes, const std::string& attempt) {
  // The kernel acts on the requests within this call; only the answers are left to read.
  posix::check(attempt, ::send(fd(), bytes.data(), bytes.size(), 0));
}

void RouteSocket::await_answer(std::uint32_t sequence, const std::string& attempt,
                               const OnReply& on_reply) {
  alignas(nlmsghdr) std::array<char, kAnswerBytes> buffer{};
  for (;;) {
    const ssize_t got = ::recv(fd(), buffer.data(), buffer.size(), 0);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    auto left = static_cast<int>(posix::check(attempt, got));
    for (const nlmsghdr* answer = reinterpret_cast<const nlmsghdr*>(buffer.data());
         ::nlmsg_ok(answer, left) != 0;
         answer = ::nlmsg_next(const_cast<nlmsghdr*>(answer), &left)) {
      check_answer(*answer, attempt);
      if (answer->nlmsg_seq != sequence) {
        continue;
      }
      if (answer->nlmsg_type == NLMSG_ERROR) {
        return;
      }
      if (on_reply) {
        on_reply(*answer);
      }
    }
  }
}

void RouteSocket::transact(RouteMessage message, const std::string& attempt,
                           const OnReply& on_reply) {
  message.header().nlmsg_seq = ++sequence_;
  message.header().nlmsg_flags |= NLM_F_ACK;
  send(message.bytes(), attempt);
  await_answer(sequence_, attempt, on_reply);
}

void RouteSocket::create_bridge(const std::string& name, std::uint32_t mtu_bytes) {
  RouteMessage message{RTM_NEWLINK, kCreate, link_header(true)};
  message.put_text(IFLA_IFNAME, name).put_u32(IFLA_MTU, mtu_bytes);
  message.nest(IFLA_LINKINFO, [&] {
    message.put_text(IFLA_INFO_KIND, "bridge").nest(IFLA_INFO_DATA, [&] {
      message.put_u32(IFLA_BR_STP_STATE, 0).put_u8(IFLA_BR_MCAST_SNOOPING, 0);
    });
  });
  transact(std::move(message), "create bridge '" + name + "'");
}

void RouteSocket::create_veth(const VethPair& pair, const posix::NetworkNamespace& peer_namespace) {
  RouteMessage message{RTM_NEWLINK, kCreate, link_header(true)};
  message.put_text(IFLA_IFNAME, pair.name)
      .put_u32(IFLA_MTU, pair.mtu_bytes)
      .put_u32(IFLA_TXQLEN, pair.queue_frames);
  if (pair.master_index != 0) {
    message.put_u32(IFLA_MASTER, pair.master_index);
  }
  message.nest(IFLA_LINKINFO, [&] {
    message.put_text(IFLA_INFO_KIND, "veth").nest(IFLA_INFO_DATA, [&] {
      constexpr int kVethInfoPeer = 1;  // VETH_INFO_PEER, linux/veth.h
      message.nest(kVethInfoPeer, [&] {
        // Not up yet: the kernel opens it before it has tied the two ends.
        message.put_header(link_header(std::nullopt))
            .put_text(IFLA_IFNAME, pair.peer_name)
            .put(IFLA_ADDRESS, pair.peer_mac)
            .put_u32(IFLA_MTU, pair.mtu_bytes)
            .put_u32(IFLA_TXQLEN, pair.queue_frames)
            .put_u32(IFLA_NET_NS_FD, static_cast<std::uint32_t>(peer_namespace.fd()));
      });
    });
  });
  transact(std::move(message), "create veth pair '" + pair.name + "'");
}

void RouteSocket::change_link(const std::string& name, const LinkChange& change) {
  RouteMessage message{RTM_NEWLINK, 0, link_header(change.up)};
  message.put_text(IFLA_IFNAME, name);
  if (change.mac) {
    message.put(IFLA_ADDRESS, *change.mac);
  }
  if (change.mtu_bytes) {
    message.put_u32(IFLA_MTU, *change.mtu_bytes);
  }
  if (change.queue_frames) {
    message.put_u32(IFLA_TXQLEN, *change.queue_frames);
  }
  if (change.master_index) {
    message.put_u32(IFLA_MASTER, *change.master_index);
  }
  transact(std::move(message), "change link '" + name + "'");
}

void RouteSocket::delete_link(const std::string& name) {
  RouteMessage message{RTM_DELLINK, 0, link_header(std::nullopt)};
  message.put_text(IFLA_IFNAME, name);
  transact(std::move(message), "delete link '" + name + "'");
}

std::uint32_t RouteSocket::index_of(const std::string& name) {
  RouteMessage message{RTM_GETLINK, 0, link_header(std::nullopt)};
  message.put_text(IFLA_IFNAME, name);
  std::uint32_t index = 0;
  transact(std::move(message), "find link '" + name + "'", [&](const nlmsghdr& answer) {
    index =
        static_cast<std::uint32_t>(static_cast<const ifinfomsg*>(::nlmsg_data(&answer))->ifi_index);
  });
  return index;
}

LinkCounters RouteSocket::counters_of(const std::string& name) {
  RouteMessage message{RTM_GETLINK, 0, link_header(std::nullopt)};
  message.put_text(IFLA_IFNAME, name);
  rtnl_link_stats64 statistics{};
  transact(std::move(message), "read counters of '" + name + "'", [&](const nlmsghdr& answer) {
    const auto bytes = attribute_of(answer, IFLA_STATS64);
    std::memcpy(&statistics, bytes.data(), std::min(bytes.size(), sizeof statistics));
  });
  return {.sent_frames = statistics.tx_packets,
          .received_frames = statistics.rx_packets,
          .send_drops = statistics.tx_dropped,
          .receive_drops = statistics.rx_dropped};
}

void RouteSocket::add_address(std::uint32_t link_index, const Ipv4Prefix& prefix) {
  ifaddrmsg header{};
  header.ifa_family = AF_INET;
  header.ifa_prefixlen = prefix.length;
  header.ifa_index = link_index;
  RouteMessage message{RTM_NEWADDR, kCreate, header};
  message.put(IFA_LOCAL, prefix.address)
      .put(IFA_ADDRESS, prefix.address)
      .put(IFA_BROADCAST, broadcast_of(prefix));
  transact(std::move(message), "add address " + to_string(prefix.address));
}

void RouteSocket::add_link_route(std::uint32_t link_index, const Ipv4Prefix& destination) {
  rtmsg header{};
  header.rtm_family = AF_INET;
  header.rtm_dst_len = destination.length;
  header.rtm_table = RT_TABLE_MAIN;
  header.rtm_protocol = RTPROT_STATIC;
  header.rtm_scope = RT_SCOPE_LINK;
  header.rtm_type = RTN_UNICAST;
  RouteMessage message{RTM_NEWROUTE, kCreate, header};
  message.put(RTA_DST, destination.address).put_u32(RTA_OIF, link_index);
  transact(std::move(message), "add route to " + to_string(destination.address));
}

void RouteSocket::add_neighbours(std::uint32_t link_index, std::span<const Neighbour> neighbours) {
  // One send is bounded by the socket's send buffer (SO_SNDBUF, 212 992 B by default).
  constexpr std::size_t kAtOnce = 500;
  const std::string attempt = "add permanent neighbours";
  while (!neighbours.empty()) {
    const auto chunk = neighbours.first(std::min(kAtOnce, neighbours.size()));
    neighbours = neighbours.subspan(chunk.size());
    std::vector<std::uint8_t> batch;
    for (const Neighbour& neighbour : chunk) {
      ndmsg header{};
      header.ndm_family = AF_INET;
      header.ndm_ifindex = static_cast<int>(link_index);
      header.ndm_state = NUD_PERMANENT;
      RouteMessage message{RTM_NEWNEIGH, NLM_F_CREATE | NLM_F_REPLACE, header};
      message.put(NDA_DST, neighbour.address).put(NDA_LLADDR, neighbour.mac);
      message.header().nlmsg_seq = ++sequence_;
      if (&neighbour == &chunk.back()) {
        message.header().nlmsg_flags |= NLM_F_ACK;
      }
      const auto bytes = message.bytes();
      batch.insert(batch.end(), bytes.begin(), bytes.end());
      batch.resize(aligned(batch.size()));
    }
    send(batch, attempt);
    await_answer(sequence_, attempt, {});
  }
}

}  // namespace cuscus::netlink
