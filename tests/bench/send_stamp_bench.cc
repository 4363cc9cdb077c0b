// What a send stamp costs the sender: CPU time of one sendto() on a node's wlan0 and of reading the
// frame from its TAP, without and with the BPF program. Needs root.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <variant>
#include <vector>

#include "common/posix/check.h"
#include "orchestrator/node/fleet.h"
#include "tests/support/test_fleet.h"

namespace {

using cuscus::node::Attachment;
using cuscus::posix::check;
using cuscus::posix::UniqueFd;

double thread_cpu_ns() {
  timespec time{};
  check("clock_gettime", ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time));
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

/// Median over rounds of the CPU time of one send and read [ns].
double cost_ns(Attachment attachment, const cuscus::netlink::SendStampRing* stamps) {
  constexpr int kRounds = 21;
  constexpr int kFrames = 5000;
  const cuscus::node::Fleet fleet{cuscus::test::test_fleet(2, attachment), {.send_stamps = stamps}};
  const auto& node = fleet.nodes()[0];
  const UniqueFd socket = node.network_namespace().run(
      [] { return UniqueFd{check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))}; });
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(9);
  ::inet_pton(AF_INET, "10.0.0.2", &to.sin_addr);
  std::array<char, 2048> buffer{};
  std::vector<double> rounds;
  for (int round = 0; round < kRounds; ++round) {
    const double start_ns = thread_cpu_ns();
    for (int i = 0; i < kFrames; ++i) {
      check("sendto", ::sendto(socket.get(), buffer.data(), 100, 0,
                               reinterpret_cast<const sockaddr*>(&to), sizeof to));
      check("read", ::read(node.tap_fd(), buffer.data(), buffer.size()));
    }
    rounds.push_back((thread_cpu_ns() - start_ns) / kFrames);
  }
  std::nth_element(rounds.begin(), rounds.begin() + kRounds / 2, rounds.end());
  return rounds[kRounds / 2];
}

}  // namespace

int main() {
  try {
    // Large enough that it never fills: a full ring would make stamps cheaper than they are.
    const auto made = cuscus::netlink::SendStampRing::create(32U << 20U);
    const auto& ring = std::get<cuscus::netlink::SendStampRing>(made);
    for (const Attachment attachment : {Attachment::kDirect, Attachment::kBridge}) {
      const double without_ns = cost_ns(attachment, nullptr);
      const double with_ns = cost_ns(attachment, &ring);
      std::printf("%s: %.0f ns for a sendto() and a read() without stamps, %.0f ns with\n",
                  attachment == Attachment::kBridge ? "bridge" : "direct", without_ns, with_ns);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "send_stamp_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
