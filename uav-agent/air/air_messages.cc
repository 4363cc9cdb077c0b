#include "uav-agent/air/air_messages.h"

#include <cmath>
#include <limits>

#include "proto/air.pb.h"

namespace cuscus::air {
namespace {
/// Of a quaternion that was rounded to single precision, generously.
constexpr double kUnitTolerance = 1e-3;

float narrowed(double x) { return static_cast<float>(x); }
}  // namespace

std::string encoded(const Beacon& beacon) {
  proto::Beacon message;
  message.set_slot(beacon.report.slot);
  message.set_sequence(beacon.report.sequence);
  message.set_sim_time_ns(static_cast<std::uint64_t>(to_ns(beacon.report.time)));
  message.set_x_m(narrowed(beacon.report.p_WB_m.x()));
  message.set_y_m(narrowed(beacon.report.p_WB_m.y()));
  message.set_z_m(narrowed(beacon.report.p_WB_m.z()));
  message.set_q_w(narrowed(beacon.q_WB.w()));
  message.set_q_x(narrowed(beacon.q_WB.x()));
  message.set_q_y(narrowed(beacon.q_WB.y()));
  message.set_q_z(narrowed(beacon.q_WB.z()));
  return message.SerializeAsString();
}

std::optional<Beacon> decoded(std::span<const std::byte> payload) {
  if (payload.empty() || payload.size() > kBeaconBytesMax) {
    return std::nullopt;
  }
  proto::Beacon message;
  if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size())) ||
      message.sim_time_ns() >
          static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return std::nullopt;
  }
  Beacon beacon;
  beacon.report = {.slot = message.slot(),
                   .sequence = message.sequence(),
                   .time = sim_time(static_cast<std::int64_t>(message.sim_time_ns())),
                   .p_WB_m = {message.x_m(), message.y_m(), message.z_m()}};
  beacon.q_WB = {message.q_w(), message.q_x(), message.q_y(), message.q_z()};
  // Written so that a NaN fails.
  if (!(std::abs(beacon.q_WB.norm() - 1.0) < kUnitTolerance)) {
    return std::nullopt;
  }
  return beacon;
}

std::string encoded(const TelemetryReport& telemetry) {
  const auto& e = telemetry.estimate;
  proto::Telemetry message;
  message.set_node(telemetry.node);
  message.set_sequence(telemetry.sequence);
  message.set_sim_time_ns(static_cast<std::uint64_t>(to_ns(e.time)));
  message.set_x_m(narrowed(e.p_WB_m.x()));
  message.set_y_m(narrowed(e.p_WB_m.y()));
  message.set_z_m(narrowed(e.p_WB_m.z()));
  message.set_vx_mps(narrowed(e.v_WB_mps.x()));
  message.set_vy_mps(narrowed(e.v_WB_mps.y()));
  message.set_vz_mps(narrowed(e.v_WB_mps.z()));
  message.set_yaw_rad(narrowed(telemetry.yaw_rad));
  message.set_state(std::string{telemetry.state});
  message.set_neighbours_heard(telemetry.neighbours_heard);
  return message.SerializeAsString();
}

}  // namespace cuscus::air
