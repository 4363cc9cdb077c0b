#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/ipc/child_session.h"
#include "ground-station/app/asio.h"
#include "ground-station/app/memory_observer.h"
#include "ground-station/app/page_server.h"
#include "ground-station/app/telemetry_socket.h"
#include "ground-station/core/fleet_picture.h"
#include "proto/report.pb.h"

namespace cuscus::gcs {

/// One run of the ground station: from its configuration to its report. One thread.
class GroundStation {
 public:
  /// Maps and binds everything that `configuration` and the descriptors in `session` ask for.
  GroundStation(ipc::ChildSession& session, const proto::GroundStationConfiguration& configuration);
  GroundStation(const GroundStation&) = delete;
  GroundStation& operator=(const GroundStation&) = delete;
  ~GroundStation() = default;

  /// Works until the orchestrator says Stop. SimTime 0 is `start_monotonic_ns`.
  /// @throws ipc::PeerError when the orchestrator is gone.
  void run(std::int64_t start_monotonic_ns);

  [[nodiscard]] proto::GroundStationReport report() const;

 private:
  [[nodiscard]] SimTime now() const;
  [[nodiscard]] std::string picture() const;
  asio::awaitable<void> publish_pictures();
  asio::awaitable<void> beat();
  asio::awaitable<void> await_stop();
  /// Lets the clients have the last picture, for a moment.
  asio::awaitable<void> farewell();
  void spawn(asio::awaitable<void> task);

  ipc::ChildSession& session_;
  SimClock::duration page_period_;
  FleetPicture fleet_;
  MemoryObserver memory_;
  std::int64_t start_monotonic_ns_{0};
  bool ended_{false};
  PageCensus census_;  // before io_, whose destructor ends what it counts
  asio::io_context io_{1};
  TelemetrySocket telemetry_;
  std::optional<PageServer> page_;
};

}  // namespace cuscus::gcs
