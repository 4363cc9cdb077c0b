#include "netsim/app/monitor_devices.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <utility>

#include "common/posix/monotonic_clock.h"

namespace cuscus::netsim {
namespace {

/// 200 ms of 100 nodes that hear 2 000 frames of 100 B per second.
constexpr std::size_t kMonitorQueueBytes = std::size_t{8} << 20U;
/// How long a packet may wait here while an interface is up. (Its time on the air is in its TSFT.)
constexpr auto kBusyPeriod = std::chrono::milliseconds{2};
constexpr auto kIdlePeriod = std::chrono::milliseconds{25};
constexpr std::int64_t kAskPeriod_ns = 100'000'000;

/// What a TUN descriptor wants before a packet (struct tun_pi): flags, and the protocol in network
/// order, here ETH_P_80211_RAW.
constexpr std::array<std::uint8_t, 4> kPacketInformation{0, 0, 0x00, 0x19};

}  // namespace

MonitorDevices::MonitorDevices(std::vector<posix::UniqueFd> devices, PpduEncoder encoder)
    : ports_(devices.size()), encoder_{std::move(encoder)}, queue_{kMonitorQueueBytes} {
  for (std::size_t node = 0; node < devices.size(); ++node) {
    if (devices[node]) {
      ports_[node].device = std::move(devices[node]);
      ports_[node].state = State::kAsk;
    }
  }
  writer_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
}

MonitorDevices::~MonitorDevices() { finish(); }

void MonitorDevices::add(const PpduRecord& record,
                         std::span<const std::uint8_t> ethernet) noexcept {
  if (!queue_.add(record, ethernet)) {
    leave_out(record.node);
    return;
  }
  State expected = State::kAsk;
  ports_[record.node].state.compare_exchange_strong(expected, State::kAsked);
}

void MonitorDevices::leave_out(std::uint32_t node) noexcept {
  left_out_ += ports_[node].state == State::kUp ? 1U : 0U;
}

void MonitorDevices::write(const PpduRecord& record, std::span<const std::uint8_t> ethernet) {
  Port& port = ports_[record.node];
  const State state = port.state;
  if (state != State::kUp && state != State::kAsked) {
    return;  // it went down while this was on its way
  }
  packet_.assign(kPacketInformation.begin(), kPacketInformation.end());
  encoder_.append(packet_, record, ethernet);
  ::ssize_t written = -1;
  while ((written = ::write(port.device.get(), packet_.data(), packet_.size())) < 0 &&
         errno == EINTR) {
  }
  if (written >= 0) {
    ++packets_;
    port.state = State::kUp;
  } else if (errno == EIO) {  // down
    port.refused_at_ns = posix::monotonic_now_ns();
    port.state = State::kDown;
  } else if (errno == EBADFD) {  // deleted
    port.state = State::kNone;
  } else {
    ++refused_;
    port.state = State::kUp;
  }
}

void MonitorDevices::ask_again() {
  const std::int64_t now_ns = posix::monotonic_now_ns();
  for (Port& port : ports_) {
    if (port.state == State::kDown && now_ns - port.refused_at_ns >= kAskPeriod_ns) {
      port.state = State::kAsk;
    }
  }
}

void MonitorDevices::write_out() {
  queue_.drain([this](const PpduRecord& record, std::span<const std::uint8_t> ethernet) {
    write(record, ethernet);
  });
}

void MonitorDevices::serve(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const std::uint64_t before = packets_;
    write_out();
    ask_again();
    std::this_thread::sleep_for(packets_ > before ? kBusyPeriod : kIdlePeriod);
  }
  write_out();
}

void MonitorDevices::finish() {
  if (writer_.joinable()) {
    writer_.request_stop();
    writer_.join();
  }
}

}  // namespace cuscus::netsim
