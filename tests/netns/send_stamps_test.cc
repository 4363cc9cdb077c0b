#include "orchestrator/netlink/send_stamps.h"

#include <arpa/inet.h>
#include <linux/bpf.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "orchestrator/netlink/bpf_program.h"
#include "orchestrator/node/fleet.h"
#include "proto/shm/send_stamp.h"
#include "tests/support/root_only.h"
#include "tests/support/test_fleet.h"

namespace cuscus::netlink {
namespace {

constexpr std::uint32_t kRingBytes = 64 * 1024;

/// Reads a BPF ring buffer as its documentation says (Documentation/bpf/ringbuf.rst): a page with
/// the consumer's position, a page with the producer's, then the data, mapped twice in a row.
class RingReader {
 public:
  explicit RingReader(int fd) {
    consumer_ = static_cast<std::uint64_t*>(map(fd, PROT_READ | PROT_WRITE, page_, 0));
    producer_ = static_cast<std::uint64_t*>(map(fd, PROT_READ, page_ + 2UL * kRingBytes, page_));
  }

  /// All stamps that are there.
  std::vector<shm::SendStamp> drain() {
    std::vector<shm::SendStamp> stamps;
    const auto* const data = reinterpret_cast<const char*>(producer_) + page_;
    std::uint64_t position = *consumer_;
    while (position < std::atomic_ref{*producer_}.load(std::memory_order_acquire)) {
      const auto* const record = data + position % kRingBytes;
      std::uint32_t length = 0;
      std::memcpy(&length, record, sizeof length);
      if ((length & BPF_RINGBUF_BUSY_BIT) != 0) {
        break;
      }
      if (length != sizeof(shm::SendStamp)) {
        throw std::runtime_error{"a record of " + std::to_string(length) + " B"};
      }
      std::memcpy(&stamps.emplace_back(), record + BPF_RINGBUF_HDR_SZ, sizeof(shm::SendStamp));
      position += BPF_RINGBUF_HDR_SZ + sizeof(shm::SendStamp);
    }
    std::atomic_ref{*consumer_}.store(position, std::memory_order_release);
    return stamps;
  }

 private:
  static void* map(int fd, int protection, std::size_t bytes, std::size_t offset) {
    void* const mapped =
        ::mmap(nullptr, bytes, protection, MAP_SHARED, fd, static_cast<off_t>(offset));
    if (mapped == MAP_FAILED) {
      posix::throw_errno("mmap of the ring");
    }
    return mapped;  // for the life of the test
  }

  std::size_t page_{static_cast<std::size_t>(::sysconf(_SC_PAGESIZE))};
  std::uint64_t* consumer_{};
  std::uint64_t* producer_{};
};

/// A UDP socket inside a node that may broadcast.
posix::UniqueFd broadcaster(const node::Node& node) {
  return node.network_namespace().run([] {
    posix::UniqueFd socket{posix::check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
    const int on = 1;
    posix::check("SO_BROADCAST",
                 ::setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on));
    return socket;
  });
}

void broadcast(const posix::UniqueFd& socket, const std::string& text) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(9);
  ::inet_pton(AF_INET, "10.0.255.255", &to.sin_addr);
  posix::check("sendto", ::sendto(socket.get(), text.data(), text.size(), 0,
                                  reinterpret_cast<const sockaddr*>(&to), sizeof to));
}

TEST_CASE("every frame is stamped with node, length, beginning and the time of its sendto") {
  CUSCUS_ROOT_ONLY();
  const auto made = SendStampRing::create(kRingBytes);
  INFO((std::holds_alternative<NotAvailable>(made) ? std::get<NotAvailable>(made).reason : ""));
  REQUIRE(std::holds_alternative<SendStampRing>(made));
  const auto& ring = std::get<SendStampRing>(made);
  const auto attachment = GENERATE(node::Attachment::kBridge, node::Attachment::kDirect);
  const node::Fleet fleet{test::test_fleet(3, attachment), {.send_stamps = &ring}};
  RingReader reader{ring.fd()};
  std::vector<posix::UniqueFd> sockets;
  for (const node::Node& node : fleet.nodes()) {
    sockets.push_back(broadcaster(node));
  }
  REQUIRE(reader.drain().empty());
  // Shorter than a stamp's head (42 B of headers and nothing else), exactly, and longer.
  const std::vector<std::size_t> payload_bytes{0, 1, 6, 7, 100, 1400};

  std::uint64_t last_ns = 0;
  for (std::uint32_t node = 0; node < sockets.size(); ++node) {
    for (const std::size_t bytes : payload_bytes) {
      const std::string text(bytes, static_cast<char>('a' + node));
      const auto before_ns = static_cast<std::uint64_t>(posix::monotonic_now_ns());
      broadcast(sockets[node], text);
      const auto after_ns = static_cast<std::uint64_t>(posix::monotonic_now_ns());

      const auto stamps = reader.drain();
      REQUIRE(stamps.size() == 1);
      const shm::SendStamp& stamp = stamps.front();
      CHECK(stamp.node == node);
      CHECK(stamp.frame_bytes == 42 + bytes);
      CHECK(before_ns <= stamp.monotonic_ns);
      CHECK(stamp.monotonic_ns <= after_ns);
      CHECK(stamp.monotonic_ns > last_ns);
      last_ns = stamp.monotonic_ns;

      // The head is what netsim will read from the TAP, and zero beyond the frame's end.
      std::vector<std::uint8_t> frame(2048);
      REQUIRE(::read(fleet.nodes()[node].tap_fd(), frame.data(), frame.size()) ==
              static_cast<ssize_t>(stamp.frame_bytes));
      CHECK(std::equal(stamp.head.begin(), stamp.head.end(), frame.begin()));
    }
  }
}

TEST_CASE("a full ring loses stamps and not frames") {
  CUSCUS_ROOT_ONLY();
  const auto ring = std::get<SendStampRing>(SendStampRing::create(4096));
  auto networks = test::test_fleet(1, node::Attachment::kDirect);
  const node::Fleet fleet{networks, {.send_stamps = &ring}};
  const auto socket = broadcaster(fleet.nodes()[0]);
  constexpr std::size_t kFrames = 200;

  for (std::size_t i = 0; i < kFrames; ++i) {
    broadcast(socket, "x");
  }

  std::vector<std::uint8_t> frame(2048);
  std::size_t arrived = 0;
  while (::read(fleet.nodes()[0].tap_fd(), frame.data(), frame.size()) > 0) {
    ++arrived;
  }
  CHECK(arrived == kFrames);
}

TEST_CASE("a program that the kernel refuses comes with the verifier's reason") {
  CUSCUS_ROOT_ONLY();
  const std::vector<bpf_insn> returns_nothing{bpf::leave()};

  CHECK_THROWS_WITH(bpf::load_traffic_program(returns_nothing, "nonsense"),
                    Catch::Contains("verifier says") && Catch::Contains("R0 !read_ok"));
}

TEST_CASE("without rights, send stamps are a value that says why they are not to be had") {
  CUSCUS_ROOT_ONLY();
  // In a child, because a process cannot take its rights back.
  const pid_t child = posix::check("fork", ::fork());
  if (child == 0) {
    posix::check("setresuid", ::setresuid(65534, 65534, 65534));
    const auto ring = SendStampRing::create(kRingBytes);
    const auto* const missing = std::get_if<NotAvailable>(&ring);
    ::_exit(missing != nullptr && !missing->reason.empty() ? 0 : 1);
  }
  int status = -1;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
}

}  // namespace
}  // namespace cuscus::netlink
