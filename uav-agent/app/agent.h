#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <optional>

#include "proto/configuration.pb.h"
#include "proto/report.pb.h"
#include "uav-agent/app/beacon_schedule.h"
#include "uav-agent/app/datagram_socket.h"
#include "uav-agent/flight/autopilot.h"
#include "uav-agent/missions/circle_mission.h"
#include "uav-agent/missions/neighbour_table.h"
#include "uav-agent/sdk/periodic_timer.h"
#include "uav-agent/sdk/vehicle.h"

namespace cuscus::agent {

/// One UAV of the circle mission: its autopilot, its mission, and its talk with the others.
class Agent {
 public:
  /// Opens the sockets.
  /// @throws std::invalid_argument for a configuration that cannot be flown, std::system_error.
  Agent(const proto::AgentConfiguration& configuration, sdk::Vehicle& vehicle);

  /// When run() next has something to do.
  [[nodiscard]] SimTime deadline() const;

  /// Does what is due at `now`: control, beacon, telemetry.
  void run(SimTime now);

  [[nodiscard]] flight::FlightState state() const { return autopilot_.state(); }
  [[nodiscard]] flight::FailsafeReason failsafe_reason() const {
    return autopilot_.failsafe_reason();
  }
  [[nodiscard]] std::uint64_t send_errors() const { return send_errors_; }
  /// CPU time and memory are left to the caller.
  [[nodiscard]] proto::AgentReport report() const;

 private:
  void control(SimTime now);
  void receive_beacons(SimTime now);
  void look_at_fleet(SimTime now);
  void send_beacon();
  void send_telemetry(SimTime now);

  proto::AgentConfiguration configuration_;
  sdk::Vehicle& vehicle_;
  flight::Autopilot autopilot_;
  missions::CircleParameters circle_;
  missions::CircleMission mission_;
  missions::NeighbourTable neighbours_;
  sdk::PeriodicTimer control_timer_;
  std::optional<BeaconSchedule> beacons_;
  std::optional<sdk::PeriodicTimer> telemetry_timer_;
  DatagramSocket beacon_socket_;
  DatagramSocket telemetry_socket_;
  sockaddr_in beacon_endpoint_{};
  sockaddr_in telemetry_endpoint_{};
  std::uint64_t loops_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t beacons_sent_ = 0;
  std::uint64_t beacons_received_ = 0;
  std::uint64_t beacons_rejected_ = 0;
  std::uint64_t send_errors_ = 0;
  std::uint32_t beacon_sequence_ = 0;
  std::uint32_t telemetry_sequence_ = 0;
};

}  // namespace cuscus::agent
