#include "orchestrator/netlink/link_watch.h"

#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netlink/attr.h>
#include <netlink/errno.h>
#include <netlink/msg.h>
#include <netlink/netlink.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/posix/check.h"

namespace cuscus::netlink {
namespace {

constexpr std::size_t kNotificationBytes = std::size_t{32} * 1024;

/// linux/if.h, which does not go together with net/if.h.
constexpr unsigned kLowerUp = 1U << 16U;

void require(int error, const char* attempt) {
  if (error < 0) {
    throw std::runtime_error{std::string{attempt} + ": " + ::nl_geterror(error)};
  }
}

std::optional<LinkWatch::Change> change_in(const nlmsghdr& notification) {
  if (notification.nlmsg_type != RTM_NEWLINK && notification.nlmsg_type != RTM_DELLINK) {
    return std::nullopt;
  }
  auto* const message = const_cast<nlmsghdr*>(&notification);
  const auto* const link = static_cast<const ifinfomsg*>(::nlmsg_data(message));
  const nlattr* const name =
      ::nlmsg_find_attr(message, static_cast<int>(sizeof(ifinfomsg)), IFLA_IFNAME);
  if (name == nullptr) {
    return std::nullopt;
  }
  return LinkWatch::Change{
      .name = ::nla_get_string(name),
      .has_carrier = notification.nlmsg_type == RTM_NEWLINK && (link->ifi_flags & kLowerUp) != 0};
}

}  // namespace

LinkWatch::LinkWatch() : socket_{::nl_socket_alloc()} {
  if (socket_ == nullptr) {
    throw std::bad_alloc{};
  }
  require(::nl_connect(socket_.get(), NETLINK_ROUTE), "open an rtnetlink socket");
  require(::nl_socket_add_memberships(socket_.get(), RTNLGRP_LINK, 0), "watch links");
  require(::nl_socket_set_nonblocking(socket_.get()), "watch links without waiting");
}

LinkWatch LinkWatch::in(const posix::NetworkNamespace& where) {
  return where.run([] { return LinkWatch{}; });
}

std::vector<LinkWatch::Change> LinkWatch::take() {
  std::vector<Change> changes;
  alignas(nlmsghdr) std::array<char, kNotificationBytes> buffer{};
  for (;;) {
    const ssize_t got = ::recv(fd(), buffer.data(), buffer.size(), 0);
    if (got < 0 && (errno == EINTR || errno == ENOBUFS)) {
      continue;
    }
    if (got < 0 && errno == EAGAIN) {
      return changes;
    }
    auto left = static_cast<int>(posix::check("read what became of links", got));
    for (const nlmsghdr* message = reinterpret_cast<const nlmsghdr*>(buffer.data());
         ::nlmsg_ok(message, left) != 0;
         message = ::nlmsg_next(const_cast<nlmsghdr*>(message), &left)) {
      if (auto change = change_in(*message)) {
        changes.push_back(std::move(*change));
      }
    }
  }
}

}  // namespace cuscus::netlink
