#include "uav-agent/app/agent.h"

#include <algorithm>
#include <array>
#include <string>

#include "uav-agent/air/air_messages.h"
#include "uav-agent/app/agent_settings.h"

namespace cuscus::agent {
namespace {

using Verdict = missions::NeighbourTable::Verdict;

/// Beacons taken in one control period: a flood must not keep the vehicle from being controlled.
constexpr int kBeaconsPerLoop = 256;

const proto::AgentConfiguration& checked(const proto::AgentConfiguration& configuration) {
  check(configuration);
  return configuration;
}

}  // namespace

Agent::Agent(const proto::AgentConfiguration& configuration, sdk::Vehicle& vehicle)
    : configuration_{checked(configuration)},
      vehicle_{vehicle},
      autopilot_{airframe(configuration), autopilot_parameters(configuration)},
      circle_{circle(configuration)},
      mission_{circle_, configuration.slot(), configuration.fleet_size()},
      neighbours_{configuration.slot(), configuration.fleet_size(),
                  SimClock::duration{configuration.neighbour_timeout_ns()}},
      control_timer_{SimClock::duration{configuration.control_period_ns()},
                     control_phase(configuration.seed(), configuration.node(),
                                   SimClock::duration{configuration.control_period_ns()})},
      beacon_socket_{configuration.beacon_port()},
      telemetry_socket_{0} {
  if (configuration.beacon_period_ns() > 0) {
    beacon_endpoint_ = endpoint(configuration.beacon_address(), configuration.beacon_port());
    beacons_.emplace(configuration.seed(), configuration.node(),
                     SimClock::duration{configuration.beacon_period_ns()});
  }
  if (!configuration.telemetry_address().empty()) {
    telemetry_endpoint_ =
        endpoint(configuration.telemetry_address(), configuration.telemetry_port());
    const SimClock::duration period{configuration.telemetry_period_ns()};
    telemetry_timer_.emplace(period,
                             control_phase(configuration.seed() + 1, configuration.node(), period));
  }
  if (configuration.has_circle()) {
    autopilot_.take_off(circle_.p_WC_centre_m.z());
  }  // Without a mission it waits on the ground.
}

SimTime Agent::deadline() const {
  SimTime next = control_timer_.deadline();
  if (beacons_) {
    next = std::min(next, beacons_->deadline());
  }
  if (telemetry_timer_) {
    next = std::min(next, telemetry_timer_->deadline());
  }
  return next;
}

void Agent::run(SimTime now) {
  if (control_timer_.due(now)) {
    overruns_ += control_timer_.advance(now);
    ++loops_;
    control(now);
  }
  if (beacons_ && beacons_->due(now)) {
    beacons_->advance(now);
    send_beacon();
  }
  if (telemetry_timer_ && telemetry_timer_->due(now)) {
    telemetry_timer_->advance(now);
    send_telemetry(now);
  }
}

void Agent::control(SimTime now) {
  receive_beacons(now);
  if (configuration_.neighbours() == proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE) {
    look_at_fleet(now);
  }
  autopilot_.sense(now, vehicle_.sensors().imu(), vehicle_.sensors().motion_capture());
  std::optional<flight::Setpoint> setpoint;
  if (autopilot_.state() == flight::FlightState::kFlying) {
    setpoint = mission_.setpoint(now, autopilot_.estimate(),
                                 missions::neighbour_angles(neighbours_, now, circle_),
                                 autopilot_.heading_rad());
  }
  vehicle_.actuators().set_motors(autopilot_.act(now, setpoint), now);
}

void Agent::receive_beacons(SimTime now) {
  // One byte more than a beacon may have, so that longer ones show.
  std::array<std::byte, air::kBeaconBytesMax + 1> buffer;
  for (int i = 0; i < kBeaconsPerLoop; ++i) {
    const auto payload = beacon_socket_.try_receive(buffer);
    if (!payload) {
      return;
    }
    const auto beacon = air::decoded(*payload);
    if (!beacon) {
      ++beacons_rejected_;
      continue;
    }
    if (configuration_.neighbours() != proto::AgentConfiguration::NEIGHBOURS_BEACONS) {
      beacons_received_ += beacon->report.slot != configuration_.slot() ? 1U : 0U;
      continue;
    }
    switch (neighbours_.accept(beacon->report, now)) {
      case Verdict::kAccepted:
      case Verdict::kOld:
        ++beacons_received_;
        break;
      case Verdict::kOwn:
        break;
      case Verdict::kUnknown:
      case Verdict::kMalformed:
        ++beacons_rejected_;
        break;
    }
  }
}

void Agent::look_at_fleet(SimTime now) {
  const auto* const fleet = vehicle_.fleet();
  const auto fleet_size = configuration_.fleet_size();
  for (const std::uint32_t slot : {(configuration_.slot() + fleet_size - 1) % fleet_size,
                                   (configuration_.slot() + 1) % fleet_size}) {
    const auto reading =
        fleet->motion_capture_of(configuration_.slot_nodes(static_cast<int>(slot)));
    if (reading) {
      static_cast<void>(
          neighbours_.accept({.slot = slot,
                              .sequence = static_cast<std::uint32_t>(reading->sequence),
                              .time = reading->time,
                              .p_WB_m = reading->p_WB_m},
                             now));
    }
  }
}

void Agent::send_beacon() {
  if (!autopilot_.ready()) {
    return;
  }
  const auto& estimate = autopilot_.estimate();
  const std::string payload = air::encoded(air::Beacon{.report = {.slot = configuration_.slot(),
                                                                  .sequence = ++beacon_sequence_,
                                                                  .time = estimate.time,
                                                                  .p_WB_m = estimate.p_WB_m},
                                                       .q_WB = estimate.q_WB});
  if (beacon_socket_.try_send(payload, beacon_endpoint_)) {
    ++beacons_sent_;
  } else {
    ++send_errors_;
  }
}

void Agent::send_telemetry(SimTime now) {
  if (!autopilot_.ready()) {
    return;
  }
  const auto& estimate = autopilot_.estimate();
  const std::string payload =
      air::encoded(air::TelemetryReport{.node = configuration_.node(),
                                        .sequence = ++telemetry_sequence_,
                                        .estimate = estimate,
                                        .yaw_rad = flight::euler_angles(estimate.q_WB).z(),
                                        .state = flight::name(autopilot_.state()),
                                        .neighbours_heard = neighbours_.heard_count(now)});
  if (!telemetry_socket_.try_send(payload, telemetry_endpoint_)) {
    ++send_errors_;
  }
}

proto::AgentReport Agent::report() const {
  proto::AgentReport report;
  report.set_final_state(std::string{flight::name(autopilot_.state())});
  report.set_loops(loops_);
  report.set_overruns(overruns_);
  report.set_beacons_sent(beacons_sent_);
  report.set_beacons_received(beacons_received_);
  report.set_beacons_rejected(beacons_rejected_);
  const auto reason = autopilot_.failsafe_reason();
  report.set_failsafes(reason == flight::FailsafeReason::kNone ? 0 : 1);
  report.set_last_failsafe_reason(std::string{flight::name(reason)});
  report.set_sensors_lost(reason == flight::FailsafeReason::kImuLost ||
                          reason == flight::FailsafeReason::kMotionCaptureLost);
  return report;
}

}  // namespace cuscus::agent
