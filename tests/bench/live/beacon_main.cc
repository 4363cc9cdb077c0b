// bench-beacon: an ordinary UDP program that broadcasts every period and counts what it hears. It
// is the load of scripts/bench-live and knows nothing of the testbed.
//
// usage: bench-beacon INDEX COUNT PERIOD_US PAYLOAD_BYTES DURATION_S BROADCAST_ADDRESS
//        [receptions] [jitter]
// prints: index sent received own_cpu_s, then the delay quantiles from sendto() to recv() [us];
// with 'receptions' a line for each as well: sender, its datagram's number, delay [us]
// 'jitter': anywhere in each period instead of at one phase of it

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/monotonic_clock.h"
#include "common/posix/resource_usage.h"
#include "common/posix/unique_fd.h"
#include "common/random/counter_stream.h"

namespace {

using cuscus::posix::check;
using cuscus::posix::monotonic_now_ns;
using cuscus::posix::UniqueFd;

constexpr std::uint16_t kPort = 5005;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr std::int64_t kSettle_ns = 2'000 * kNanosecondsPerMillisecond;
constexpr int kExitUsage = 2;

struct Options {
  std::uint32_t index;
  std::uint32_t count;
  std::int64_t period_ns;
  std::size_t payload_bytes;
  std::int64_t duration_ns;
  std::string broadcast_address;
  bool print_receptions{false};
  bool jitter{false};
};

/// The first bytes of each datagram.
struct Stamp {
  std::uint32_t index;
  std::uint32_t sequence;
  std::int64_t sent_ns;
};

struct Reception {
  std::uint32_t sender;
  std::uint32_t sequence;
  double delay_us;
};

Options parse(std::span<char* const> args) {
  const auto words = args.subspan(std::min<std::size_t>(args.size(), 7));
  const auto has = [&](std::string_view word) {
    return std::count(words.begin(), words.end(), word) > 0;
  };
  if (args.size() < 7 ||
      words.size() != static_cast<std::size_t>(has("receptions")) + std::size_t{has("jitter")}) {
    std::fputs(
        "usage: bench-beacon INDEX COUNT PERIOD_US PAYLOAD_BYTES DURATION_S BROADCAST "
        "[receptions] [jitter]\n",
        stderr);
    std::exit(kExitUsage);  // NOLINT(concurrency-mt-unsafe): no other thread
  }
  return {.index = static_cast<std::uint32_t>(std::stoul(args[1])),
          .count = static_cast<std::uint32_t>(std::stoul(args[2])),
          .period_ns = std::stoll(args[3]) * 1000,
          .payload_bytes = std::max(sizeof(Stamp), static_cast<std::size_t>(std::stoul(args[4]))),
          .duration_ns = std::stoll(args[5]) * 1000 * kNanosecondsPerMillisecond,
          .broadcast_address = args[6],
          .print_receptions = has("receptions"),
          .jitter = has("jitter")};
}

UniqueFd open_socket() {
  UniqueFd socket{check("socket", ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  const int on = 1;
  check("SO_BROADCAST", ::setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on));
  const int bytes = 1 << 20;
  check("SO_RCVBUF", ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_port = htons(kPort);
  check("bind", ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any));
  return socket;
}

sockaddr_in destination(const std::string& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kPort);
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) {
    throw std::runtime_error{"'" + address + "' is not an IPv4 address"};
  }
  return to;
}

class Beacon {
 public:
  explicit Beacon(const Options& options)
      : options_{options},
        socket_{open_socket()},
        to_{destination(options.broadcast_address)},
        datagram_(options.payload_bytes) {}

  void run() {
    // By then the others are there to hear it.
    const std::int64_t start = monotonic_now_ns() + kSettle_ns;
    for (std::uint64_t period = 0;; ++period) {
      const double turns = static_cast<double>(period) + phase(period);
      const auto due =
          start + static_cast<std::int64_t>(turns * static_cast<double>(options_.period_ns));
      if (due >= start + options_.duration_ns) {
        break;
      }
      receive_until(due);
      send();
    }
    receive_until(monotonic_now_ns() + 500 * kNanosecondsPerMillisecond);
  }

  void print() const {
    std::vector<double> delays_us;
    for (const Reception& reception : receptions_) {
      delays_us.push_back(reception.delay_us);
    }
    std::sort(delays_us.begin(), delays_us.end());
    const auto quantile = [&](double q) {
      return delays_us.empty() ? 0.0
                               : delays_us[static_cast<std::size_t>(
                                     q * static_cast<double>(delays_us.size() - 1))];
    };
    std::printf("%u %u %zu %.3f %.1f %.1f %.1f\n", options_.index, sequence_, delays_us.size(),
                cuscus::posix::process_cpu_s(), quantile(0.5), quantile(0.99), quantile(1.0));
    if (options_.print_receptions) {
      for (const Reception& reception : receptions_) {
        std::printf("%u %u %.1f\n", reception.sender, reception.sequence, reception.delay_us);
      }
    }
  }

 private:
  /// Where in a period its datagram is sent, 0 ... 1.
  [[nodiscard]] double phase(std::uint64_t period) const {
    if (options_.jitter) {
      return phases_.uniform(period);
    }
    // Spread by the golden ratio: no two senders of a fleet start together.
    const double turn = static_cast<double>(options_.index) * 0.6180339887498949;
    return turn - static_cast<double>(static_cast<std::int64_t>(turn));
  }

  void send() {
    const Stamp stamp{
        .index = options_.index, .sequence = sequence_, .sent_ns = monotonic_now_ns()};
    std::memcpy(datagram_.data(), &stamp, sizeof stamp);
    if (::sendto(socket_.get(), datagram_.data(), datagram_.size(), 0,
                 reinterpret_cast<const sockaddr*>(&to_), sizeof to_) >= 0) {
      ++sequence_;
    }
  }

  void receive_until(std::int64_t deadline_ns) {
    for (;;) {
      const std::int64_t left_ns = deadline_ns - monotonic_now_ns();
      if (left_ns <= 0) {
        return;
      }
      pollfd readable{.fd = socket_.get(), .events = POLLIN, .revents = 0};
      const timespec timeout{.tv_sec = left_ns / 1'000'000'000, .tv_nsec = left_ns % 1'000'000'000};
      if (::ppoll(&readable, 1, &timeout, nullptr) > 0) {
        receive();
      }
    }
  }

  void receive() {
    std::array<std::byte, 2048> buffer{};
    while (::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT) >=
           static_cast<ssize_t>(sizeof(Stamp))) {
      Stamp stamp{};
      std::memcpy(&stamp, buffer.data(), sizeof stamp);
      if (stamp.index != options_.index) {
        receptions_.push_back(
            {.sender = stamp.index,
             .sequence = stamp.sequence,
             .delay_us = static_cast<double>(monotonic_now_ns() - stamp.sent_ns) * 1e-3});
      }
    }
  }

  Options options_;
  UniqueFd socket_;
  sockaddr_in to_;
  std::vector<std::byte> datagram_;
  cuscus::random::CounterStream phases_{1, options_.index};
  std::uint32_t sequence_{0};
  std::vector<Reception> receptions_;
};

}  // namespace

int main(int argc, char* argv[]) try {
  Beacon beacon{parse(std::span{argv, static_cast<std::size_t>(argc)})};
  beacon.run();
  beacon.print();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench-beacon: %s\n", error.what());
  return 1;
}
