#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/statistics/log2_histogram.h"
#include "netsim/air/air.h"
#include "netsim/app/canary_link.h"
#include "netsim/app/capture_files.h"
#include "netsim/app/due_copies.h"
#include "netsim/app/ethernet.h"
#include "netsim/app/frame_log.h"
#include "netsim/app/frame_store.h"
#include "netsim/app/link_counts.h"
#include "netsim/app/neighbour_readings.h"
#include "netsim/app/ppdu_recorder.h"
#include "netsim/app/reception_log.h"
#include "netsim/app/stamp_matcher.h"
#include "netsim/app/stamp_ring.h"
#include "netsim/app/tap_port.h"
#include "proto/report.pb.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::netsim {

/// What a live run needs; node i of `air` has address i and TAP i.
struct LiveSetup {
  AirParameters air;
  std::vector<std::uint64_t> addresses;
  /// An empty one: a node without interface. With a canary its two follow.
  std::vector<posix::UniqueFd> taps;
  Duration canary_delay{0};                  ///< 0: no canary.
  std::unique_ptr<StampRing> stamps;         ///< None: frames are taken as sent when they are read.
  std::unique_ptr<FrameLog> log;             ///< None: no log.
  std::unique_ptr<CaptureFiles> captures;    ///< None: no captures.
  std::unique_ptr<MonitorDevices> monitors;  ///< None: no monitor interfaces.
  std::span<std::byte> radio_memory{};       ///< Empty: nothing is published.
  /// By node, what its program may read of its radio; nothing and empty: nobody asks.
  std::vector<std::span<std::byte>> radio_readings{};
  posix::UniqueFd reception_log{};   ///< Empty: none.
  std::vector<std::string> names{};  ///< Of the nodes, for the reception log.
};

/// Whoever runs a LiveAir.
class LiveOwner {
 public:
  virtual ~LiveOwner() = default;
  /// Polled; when it is readable, should_stop() is asked.
  [[nodiscard]] virtual int fd() const = 0;
  [[nodiscard]] virtual bool should_stop() = 0;
  /// Twice a second.
  virtual void beat(SimTime now) = 0;
};

/// The air between real interfaces: see docs/adr/0003-ingress-and-release.md.
///
/// One thread does everything but writing the frame log, captures and to monitor
/// interfaces. Frames enter the simulation
/// at the time at which they were sent; no event runs before its time; copies are written one at a
/// time, the ring of send stamps being drained and due events run in between.
class LiveAir final : private AirListener {
 public:
  /// @throws std::invalid_argument, std::system_error.
  LiveAir(LiveSetup setup, PositionSource& positions);

  /// Forgets what was sent so far and takes `start_monotonic_ns` for SimTime 0. Then run() until
  /// the owner wants to stop.
  void run(std::int64_t start_monotonic_ns, LiveOwner& owner);

  /// Of the run so far in LiveOwner::beat(), whole after run(); without `nodes`.
  [[nodiscard]] proto::RadioReport report() const;
  /// Likewise, of one node.
  [[nodiscard]] proto::NodeServiceReport service_report(std::uint32_t node) const;
  [[nodiscard]] shm::RadioTally tally(std::uint32_t node) const;

 private:
  /// Between looks at the TAPs while stamps announce frames.
  static constexpr std::int64_t kService_ns = 20'000;

  struct Port {
    explicit Port(posix::UniqueFd fd) : tap{std::move(fd)} {}
    TapPort tap;
    StampMatcher matcher;
    std::vector<std::uint8_t> held;  ///< A frame that waits for its stamp to be written.
    bool emptied{true};              ///< The last read_tap() left nothing behind.
    std::uint64_t outstanding{0};    ///< Frames that the air has and is not done with.
    std::uint64_t most_outstanding{0};
    std::uint64_t refused{0};  ///< For want of a place in the air.
    std::uint64_t malformed{0};
    std::uint64_t before_air{0};
    std::uint64_t lost_interface{0};
    std::uint64_t clamps{0};
    std::uint64_t releases{0};
    std::uint64_t late_releases{0};
    std::int64_t release_lateness_max_ns{0};
    bool failure_logged{false};
  };

  // AirListener
  void delivered(const Delivery& delivery) override;
  void finished(const FrameReport& report) override;

  [[nodiscard]] std::int64_t now_ns() const;
  void forget_the_past();
  void step(LiveOwner& owner);
  void run_due_events();
  void wait(LiveOwner& owner, std::int64_t now);
  void sleep(LiveOwner& owner, std::int64_t timeout_ns);

  void drain_stamps();
  void take(const shm::SendStamp& stamp);
  void offer(std::uint32_t frame, std::span<const std::uint8_t> head, std::int64_t entered_ns);

  bool service_taps();
  bool read_tap(std::uint32_t node);
  bool take(std::uint32_t node, std::span<const std::uint8_t> bytes);
  void arrived(std::uint32_t frame, std::span<const std::uint8_t> bytes);
  void lost(std::span<const std::uint32_t> frames);
  void give_up_lost_frames(std::int64_t now);
  void write_one_copy();
  void note_lateness(Port& port, std::int64_t lateness_ns);
  void lose_copy(const DueCopy& copy, logs::Cause cause);
  void close_logs();
  void tell_programs(const LiveSetup& setup);

  void housekeep(LiveOwner& owner, std::int64_t now);
  void publish(std::uint32_t first, std::uint32_t count);
  void publish_timing();

  AddressBook addresses_;
  std::vector<Port> ports_;
  std::unique_ptr<StampRing> stamps_;
  std::unique_ptr<FrameLog> log_;
  std::optional<shm::RadioMemoryWriter> radio_memory_;
  FrameStore frames_;
  std::optional<LinkCounts> link_counts_;
  std::optional<NeighbourReadings> neighbours_;
  std::optional<ReceptionLog> receptions_;
  std::optional<PpduRecorder> recorder_;  ///< When there are captures or monitor interfaces.
  AirMonitors monitors_;
  std::unique_ptr<FrameCarrier> air_;
  posix::UniqueFd wake_;  ///< epoll: owner and stamps, or owner and TAPs.
  posix::UniqueFd taps_;  ///< epoll: all TAPs.

  std::int64_t start_ns_{0};
  bool stop_{false};
  DueCopies copies_;
  CanaryLink canary_;
  std::uint64_t awaited_{0};  ///< Frames whose payload has not been read.
  std::uint32_t held_{0};
  std::vector<std::uint8_t> buffer_;

  std::int64_t service_at_{0};
  std::int64_t service_ns_{0};
  std::int64_t housekeep_at_{0};
  std::int64_t beat_at_{0};
  std::int64_t slept_at_{0};
  std::uint32_t publish_next_{0};
  std::uint64_t ticks_{0};

  statistics::Log2Histogram ingress_delay_;
  statistics::Log2Histogram release_lateness_;
  statistics::Log2Histogram clamp_;
  std::uint64_t unstamped_{0};
  std::uint64_t not_logged_{0};
  std::uint64_t receptions_not_logged_{0};
  std::string scheduler_;
  double cpu_s_{0.0};
};

}  // namespace cuscus::netsim
