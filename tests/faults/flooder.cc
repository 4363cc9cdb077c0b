// flooder: an ordinary UDP program that sends far more than the air carries.
//
// usage: flooder ADDRESS BITS_PER_S SECONDS
// prints: sent DATAGRAMS at BITS_PER_S b/s, of Ethernet frames

#include <arpa/inet.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <stdexcept>
#include <string>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/unique_fd.h"

namespace {

using namespace cuscus;  // NOLINT(google-build-using-namespace): a program's own main file

constexpr std::uint16_t kPort = 5555;
constexpr std::size_t kPayloadBytes = 1472;  // fills the MTU of 1500
constexpr std::size_t kFrameBytes = kPayloadBytes + 8 + 20 + 14;
constexpr std::size_t kBatch = 64;

posix::UniqueFd connected_socket(const std::string& address) {
  posix::UniqueFd socket{posix::check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  const int on = 1;
  posix::check("SO_BROADCAST",
               ::setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kPort);
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) {
    throw std::runtime_error{"'" + address + "' is not an IPv4 address"};
  }
  posix::check("connect",
               ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to));
  return socket;
}

/// How many of `count` datagrams the kernel took.
std::uint64_t send_some(int fd, std::size_t count) {
  static std::array<std::byte, kPayloadBytes> payload{};
  std::array<iovec, kBatch> pieces{};
  std::array<mmsghdr, kBatch> messages{};
  for (std::size_t i = 0; i < count; ++i) {
    pieces.at(i) = {.iov_base = payload.data(), .iov_len = payload.size()};
    messages.at(i).msg_hdr.msg_iov = &pieces.at(i);
    messages.at(i).msg_hdr.msg_iovlen = 1;
  }
  const int sent = ::sendmmsg(fd, messages.data(), static_cast<unsigned>(count), 0);
  if (sent < 0 && errno != ENOBUFS && errno != EINTR) {
    posix::throw_errno("sendmmsg");
  }
  return static_cast<std::uint64_t>(std::max(0, sent));
}

void flood(const std::string& address, double bits_per_s, double seconds) {
  const auto socket = connected_socket(address);
  const double frames_per_ns = bits_per_s / (8.0 * kFrameBytes) * 1e-9;
  const std::int64_t begin_ns = posix::monotonic_now_ns();
  std::uint64_t sent = 0;
  std::int64_t flooded_ns = 0;
  while (static_cast<double>(flooded_ns) < seconds * 1e9) {
    const double due = frames_per_ns * static_cast<double>(flooded_ns);
    const double behind = due - static_cast<double>(sent);
    if (behind >= 1.0) {
      sent += send_some(socket.get(),
                        static_cast<std::size_t>(std::min(behind, static_cast<double>(kBatch))));
    }
    flooded_ns = posix::monotonic_now_ns() - begin_ns;
  }
  std::printf("sent %llu at %.0f b/s\n", static_cast<unsigned long long>(sent),
              8e9 * kFrameBytes * static_cast<double>(sent) / static_cast<double>(flooded_ns));
}

}  // namespace

int main(int argc, char* argv[]) try {
  const std::span<char* const> args{argv, static_cast<std::size_t>(argc)};
  if (args.size() != 4) {
    std::fputs("usage: flooder ADDRESS BITS_PER_S SECONDS\n", stderr);
    return 2;
  }
  flood(args[1], std::stod(args[2]), std::stod(args[3]));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "flooder: %s\n", error.what());
  return 1;
}
