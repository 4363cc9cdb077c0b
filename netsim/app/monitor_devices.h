#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "common/posix/unique_fd.h"
#include "netsim/app/ppdu_queue.h"
#include "netsim/capture/ppdu_encoder.h"

namespace cuscus::netsim {

/// Feeds the monitor interfaces of nodes (mon0): TUN descriptors whose packets are radiotap headers
/// and frames. Writes come from a thread of its own: add() never waits for them.
///
/// An interface that is down, as mon0 is until somebody wants it, refuses what is written to it.
/// Its node's PPDUs are then left alone, but for one every 100 ms, which asks again.
class MonitorDevices {
 public:
  /// `devices`: by node, non-blocking; empty: none.
  MonitorDevices(std::vector<posix::UniqueFd> devices, PpduEncoder encoder);
  MonitorDevices(const MonitorDevices&) = delete;
  MonitorDevices& operator=(const MonitorDevices&) = delete;
  MonitorDevices(MonitorDevices&&) = delete;
  MonitorDevices& operator=(MonitorDevices&&) = delete;
  ~MonitorDevices();

  // From one thread.
  /// Whether the interface is up, or has to be asked.
  [[nodiscard]] bool wants(std::uint32_t node) const {
    const State state = ports_[node].state.load(std::memory_order_relaxed);
    return state == State::kUp || state == State::kAsk;
  }
  void add(const PpduRecord& record, std::span<const std::uint8_t> ethernet) noexcept;
  /// What an interface that is up should have got is lost.
  void leave_out(std::uint32_t node) noexcept;

  /// Writes what is left; nothing may be added any more.
  void finish();
  // After finish(), of all nodes.
  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  [[nodiscard]] std::uint64_t packets_left_out() const { return left_out_ + refused_; }

 private:
  /// kAsk -> kAsked is for the adding thread to make, every other change for the writing one, so
  /// that never both may.
  enum class State : std::uint8_t {
    kNone,   ///< No such interface, or one that is broken for good.
    kDown,   ///< It has just refused a packet.
    kAsk,    ///< The next packet is to be tried.
    kAsked,  ///< It is on its way.
    kUp,
  };
  struct Port {
    posix::UniqueFd device;
    std::atomic<State> state{State::kNone};
    std::int64_t refused_at_ns{0};  ///< The writing thread's.
  };

  void serve(const std::stop_token& stop);
  void write_out();
  void write(const PpduRecord& record, std::span<const std::uint8_t> ethernet);
  void ask_again();

  std::vector<Port> ports_;
  PpduEncoder encoder_;
  PpduQueue queue_;
  std::vector<std::uint8_t> packet_;
  std::uint64_t packets_{0};
  std::uint64_t refused_{0};   ///< By an interface that is up.
  std::uint64_t left_out_{0};  ///< The adding thread's.
  std::jthread writer_;
};

}  // namespace cuscus::netsim
