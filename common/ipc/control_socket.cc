#include "common/ipc/control_socket.h"

#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "common/posix/check.h"

namespace cuscus::ipc {
namespace {

using posix::check;
using posix::UniqueFd;

/// As large as a message, so that a Configure for a thousand nodes passes in one packet.
void enlarge_buffers(int fd) {
  const int bytes = static_cast<int>(2 * ControlSocket::kMaxMessageBytes);
  // The FORCE variant needs CAP_NET_ADMIN; the plain one takes what rmem_max and wmem_max allow.
  if (::setsockopt(fd, SOL_SOCKET, SO_SNDBUFFORCE, &bytes, sizeof bytes) != 0) {
    check("SO_SNDBUF", ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes));
  }
}

/// Receives until neither a signal nor a reset comes between. An end that closed with messages it
/// never read leaves ECONNRESET here, once: what it sent before, then its end, follow it.
template <typename Receive>
ssize_t receive_past_interruptions(Receive&& receive) {
  ssize_t length = -1;
  do {
    length = receive();
  } while (length < 0 && (errno == EINTR || errno == ECONNRESET));
  return length;
}

std::vector<UniqueFd> take_descriptors(const msghdr& header) {
  std::vector<UniqueFd> taken;
  for (const cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr;
       part = CMSG_NXTHDR(const_cast<msghdr*>(&header), const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) {
      continue;
    }
    const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(part) + i * sizeof fd, sizeof fd);
      taken.emplace_back(fd);
    }
  }
  return taken;
}

}  // namespace

ControlSocket::ControlSocket(UniqueFd fd) : fd_{std::move(fd)} {}

std::pair<ControlSocket, ControlSocket> ControlSocket::pair() {
  std::array<int, 2> ends{};
  check("socketpair", ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()));
  std::pair<ControlSocket, ControlSocket> sockets{ControlSocket{UniqueFd{ends[0]}},
                                                  ControlSocket{UniqueFd{ends[1]}}};
  enlarge_buffers(ends[0]);
  enlarge_buffers(ends[1]);
  return sockets;
}

void ControlSocket::send(const proto::Envelope& envelope, std::span<const int> descriptors) {
  static_cast<void>(send(envelope, descriptors, 0));
}

bool ControlSocket::try_send(const proto::Envelope& envelope) {
  return send(envelope, {}, MSG_DONTWAIT);
}

bool ControlSocket::send(const proto::Envelope& envelope, std::span<const int> descriptors,
                         int flags) {
  if (descriptors.size() > kMaxDescriptors) {
    throw std::length_error{"a control message carries at most 200 descriptors"};
  }
  std::string bytes = envelope.SerializeAsString();
  if (bytes.size() > kMaxMessageBytes) {
    throw std::length_error{"a control message of " + std::to_string(bytes.size()) +
                            " B is longer than 1 MiB"};
  }
  iovec payload{.iov_base = bytes.data(), .iov_len = bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMaxDescriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &payload;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    header.msg_control = control.data();
    header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* const part = CMSG_FIRSTHDR(&header);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(part), descriptors.data(), descriptors.size_bytes());
  }
  while (::sendmsg(fd_.get(), &header, flags | MSG_NOSIGNAL) < 0) {
    if (errno == EINTR) {
      continue;
    }
    if (errno == EAGAIN && (flags & MSG_DONTWAIT) != 0) {
      return false;
    }
    if (errno == EPIPE || errno == ECONNRESET) {
      throw PeerError{"the other end of the control socket is gone"};
    }
    posix::throw_errno("send on the control socket");
  }
  return true;
}

ControlSocket::Received ControlSocket::receive() { return receive(0).value(); }

std::optional<ControlSocket::Received> ControlSocket::try_receive() {
  return receive(MSG_DONTWAIT);
}

std::optional<ControlSocket::Received> ControlSocket::receive(int flags) {
  // Its length first: most messages are tiny, and an agent should not keep a mebibyte for them.
  const ssize_t length = receive_past_interruptions(
      [&] { return ::recv(fd_.get(), nullptr, 0, flags | MSG_PEEK | MSG_TRUNC); });
  if (length < 0 && errno == EAGAIN && (flags & MSG_DONTWAIT) != 0) {
    return std::nullopt;
  }
  if (length < 0) {
    posix::throw_errno("receive on the control socket");
  }
  std::string bytes(static_cast<std::size_t>(length), '\0');
  iovec payload{.iov_base = bytes.data(), .iov_len = bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMaxDescriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &payload;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  const ssize_t got = receive_past_interruptions(
      [&] { return ::recvmsg(fd_.get(), &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC); });
  if (got < 0) {
    posix::throw_errno("receive on the control socket");
  }
  Received received{.envelope = {}, .descriptors = take_descriptors(header)};
  if (got == 0) {
    throw PeerError{"the other end of the control socket is closed"};
  }
  if (!received.envelope.ParseFromString(bytes)) {
    throw PeerError{"the other end of the control socket sent what is no message"};
  }
  return received;
}

}  // namespace cuscus::ipc
