#pragma once

#include <string>

#include "common/ipc/child_session.h"
#include "proto/configuration.pb.h"
#include "proto/report.pb.h"
#include "uav-agent/sdk/sim/sim_vehicle.h"

namespace cuscus::sdk {

/// A flying program's place in a simulated run, from its start to its report:
///
///   auto child = ipc::ChildSession::from_environment();
///   SimSession session{child};
///   ... open sockets, as session.configuration() says ...
///   if (session.wait_for_start()) {
///     while (!session.stop_requested()) { ...; session.beat("flying"); }
///   }
///   session.finish(report);
///
/// Everything throws ipc::PeerError once the orchestrator is gone.
class SimSession {
 public:
  /// Waits for the configuration and maps the vehicle's memories. `session` outlives this object.
  explicit SimSession(ipc::ChildSession& session);

  [[nodiscard]] const proto::AgentConfiguration& configuration() const { return configuration_; }
  [[nodiscard]] Vehicle& vehicle() { return vehicle_; }

  /// Says that the program is ready and waits for the run to begin; false when it was called off.
  [[nodiscard]] bool wait_for_start();
  /// Whether the program is to end. Never waits.
  [[nodiscard]] bool stop_requested() { return session_.stop_requested(); }
  /// To be said at least once a second; `state` as in telemetry.
  void beat(const std::string& state);
  /// The last word.
  void finish(const proto::AgentReport& report);

 private:
  ipc::ChildSession& session_;
  proto::AgentConfiguration configuration_;
  SimVehicle vehicle_;
};

}  // namespace cuscus::sdk
