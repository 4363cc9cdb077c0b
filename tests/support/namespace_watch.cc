#include "tests/support/namespace_watch.h"

#include <linux/net_namespace.h>
#include <linux/rtnetlink.h>
#include <netlink/msg.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>

#include "common/posix/check.h"
#include "orchestrator/netlink/route_message.h"

namespace cuscus::test {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{32} * 1024;

posix::UniqueFd open_listener() {
  posix::UniqueFd socket{posix::check(
      "open an rtnetlink socket", ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE))};
  // A thousand ends may come at once.
  const int bytes = 16 << 20;
  posix::check("SO_RCVBUFFORCE",
               ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes));
  const int group = RTNLGRP_NSID;
  posix::check(
      "listen for namespace ends",
      ::setsockopt(socket.get(), SOL_NETLINK, NETLINK_ADD_MEMBERSHIP, &group, sizeof group));
  return socket;
}

}  // namespace

NamespaceWatch::NamespaceWatch()
    : home_{posix::NetworkNamespace::create()}, socket_{home_.run(open_listener)} {}

void NamespaceWatch::add(int namespace_fd) {
  netlink::RouteMessage message{RTM_NEWNSID, NLM_F_ACK, rtgenmsg{.rtgen_family = AF_UNSPEC}};
  message.put_u32(NETNSA_NSID, sequence_)
      .put_u32(NETNSA_FD, static_cast<std::uint32_t>(namespace_fd));
  message.header().nlmsg_seq = ++sequence_;
  const auto bytes = message.bytes();
  posix::check("watch a namespace", ::send(socket_.get(), bytes.data(), bytes.size(), 0));
  ++living_;
  alignas(nlmsghdr) std::array<char, kBufferBytes> buffer{};
  for (;;) {
    auto left = static_cast<int>(
        posix::check("watch a namespace", ::recv(socket_.get(), buffer.data(), buffer.size(), 0)));
    for (auto* answer = reinterpret_cast<nlmsghdr*>(buffer.data()); ::nlmsg_ok(answer, left) != 0;
         answer = ::nlmsg_next(answer, &left)) {
      if (answer->nlmsg_type == RTM_DELNSID) {
        --living_;
      } else if (answer->nlmsg_type == NLMSG_ERROR && answer->nlmsg_seq == sequence_) {
        if (static_cast<const nlmsgerr*>(::nlmsg_data(answer))->error != 0) {
          throw std::runtime_error{"the kernel does not give a namespace a number"};
        }
        return;
      }
    }
  }
}

std::size_t NamespaceWatch::await_end(std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  alignas(nlmsghdr) std::array<char, kBufferBytes> buffer{};
  while (living_ > 0) {
    const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                             deadline - std::chrono::steady_clock::now())
                             .count();
    pollfd readable{.fd = socket_.get(), .events = POLLIN, .revents = 0};
    if (left_ms < 0 || ::poll(&readable, 1, static_cast<int>(left_ms)) == 0) {
      break;
    }
    auto left = static_cast<int>(posix::check(
        "wait for namespaces to end", ::recv(socket_.get(), buffer.data(), buffer.size(), 0)));
    for (auto* event = reinterpret_cast<nlmsghdr*>(buffer.data()); ::nlmsg_ok(event, left) != 0;
         event = ::nlmsg_next(event, &left)) {
      living_ -= event->nlmsg_type == RTM_DELNSID ? 1U : 0U;
    }
  }
  return living_;
}

}  // namespace cuscus::test
