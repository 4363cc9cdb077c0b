#include "orchestrator/results/report_json.h"

#include <nlohmann/json.hpp>

namespace cuscus::orchestrator {

using Json = nlohmann::ordered_json;

Json json_of(const proto::DurationSummary& summary) {
  Json bins = Json::array();
  for (const std::uint64_t count : summary.log2_bins()) {
    bins.push_back(count);
  }
  return {{"count", summary.count()},   {"p50_ns", summary.p50_ns()},
          {"p99_ns", summary.p99_ns()}, {"p999_ns", summary.p999_ns()},
          {"max_ns", summary.max_ns()}, {"log2_bins", bins}};
}

Json json_of(const proto::RadioReport& report) {
  return {{"send_stamps", report.send_stamps()},
          {"scheduler", report.scheduler()},
          {"processor", report.has_processor() ? Json(report.processor()) : Json()},
          {"ingress_delay", json_of(report.ingress_delay())},
          {"release_lateness", json_of(report.release_lateness())},
          {"clamps", report.clamps()},
          {"clamp", json_of(report.clamp())},
          {"events", report.events()},
          {"cpu_s", report.cpu_s()},
          {"lost_before_air", report.lost_before_air()},
          {"unstamped", report.unstamped()},
          {"frames_not_logged", report.frames_not_logged()},
          {"receptions_not_logged", report.receptions_not_logged()},
          {"packets_captured", report.packets_captured()},
          {"packets_not_captured", report.packets_not_captured()},
          {"packets_monitored", report.packets_monitored()},
          {"packets_not_monitored", report.packets_not_monitored()}};
}

Json json_of(const proto::NodeServiceReport& report) {
  return {{"queue_high_water", report.queue_high_water()},
          {"clamps", report.clamps()},
          {"releases", report.releases()},
          {"late_releases", report.late_releases()},
          {"release_lateness_max_ns", report.release_lateness_max_ns()}};
}

Json json_of(const proto::WorldReport& report) {
  return {{"steps", report.steps()},
          {"overruns", report.overruns()},
          {"step_lateness", json_of(report.step_lateness())},
          {"scheduler", report.scheduler()},
          {"cpu_s", report.cpu_s()}};
}

Json json_of(const proto::CollisionTally& tally) {
  return {{"contacts", tally.buildings() + tally.ground() + tally.trees() + tally.vehicles()},
          {"buildings", tally.buildings()},
          {"ground", tally.ground()},
          {"trees", tally.trees()},
          {"vehicles", tally.vehicles()},
          {"crashed", tally.crashed()}};
}

Json json_of(const proto::AgentReport& report) {
  return {{"final_state", report.final_state()},
          {"loops", report.loops()},
          {"overruns", report.overruns()},
          {"beacons_sent", report.beacons_sent()},
          {"beacons_received", report.beacons_received()},
          {"beacons_rejected", report.beacons_rejected()},
          {"failsafes", report.failsafes()},
          {"last_failsafe_reason", report.last_failsafe_reason()},
          {"cpu_s", report.cpu_s()},
          {"resident_bytes", report.resident_bytes()}};
}

Json json_of(const proto::GroundStationReport& report) {
  return {{"telemetry_received", report.telemetry_received()},
          {"telemetry_rejected", report.telemetry_rejected()},
          {"page_clients", report.page_clients()},
          {"cpu_s", report.cpu_s()}};
}

Json json_of(const proto::CameraReport& report) {
  return {{"renderer", report.renderer()},
          {"scheduler", report.scheduler()},
          {"drawing", json_of(report.drawing())},
          {"cpu_s", report.cpu_s()}};
}

Json json_of(const proto::CameraTally& tally) {
  return {{"pictures", tally.pictures()}, {"late", tally.late()}, {"skipped", tally.skipped()}};
}

Json json_of(const shm::RadioTally& tally) {
  return {{"offered", tally.offered},
          {"transmissions", tally.transmissions},
          {"retries", tally.retries},
          {"acknowledged", tally.acknowledged},
          {"received", tally.received},
          {"dropped_queue_full", tally.dropped_queue_full},
          {"dropped_lifetime", tally.dropped_lifetime},
          {"dropped_retry_limit", tally.dropped_retry_limit},
          {"dropped_malformed", tally.dropped_malformed},
          {"dropped_before_air", tally.dropped_before_air},
          {"lost_below_floor", tally.lost_below_floor},
          {"lost_below_detection", tally.lost_below_detection},
          {"lost_noise", tally.lost_noise},
          {"lost_collision", tally.lost_collision},
          {"lost_interference", tally.lost_interference},
          {"lost_half_duplex", tally.lost_half_duplex},
          {"lost_jammed", tally.lost_jammed},
          {"lost_interface", tally.lost_interface}};
}

Json json_of(const shm::CommandTally& tally) {
  return {{"accepted", tally.accepted},
          {"rejected_not_finite", tally.rejected_not_finite},
          {"rejected_out_of_range", tally.rejected_out_of_range},
          {"rejected_torn", tally.rejected_torn},
          {"timeouts", tally.timeouts}};
}

}  // namespace cuscus::orchestrator
