// What a LiveAir says of itself: while it runs to whoever maps its memory, and in reports.
#include <algorithm>

#include "common/ipc/duration_summary.h"
#include "netsim/app/live_air.h"

namespace cuscus::netsim {

shm::RadioTally LiveAir::tally(std::uint32_t node) const {
  const Tally& air = air_->tally(node);
  const Port& port = ports_[node];
  return {.offered = air.offered + port.malformed + port.refused,
          .transmissions = air.transmissions,
          .retries = air.retries,
          .acknowledged = air.acknowledged,
          .received = air.received - port.lost_interface,
          .dropped_queue_full = air.dropped_queue_full + port.refused,
          .dropped_lifetime = air.dropped_lifetime,
          .dropped_retry_limit = air.dropped_retry_limit,
          .dropped_malformed = port.malformed + air.dropped_too_long,
          .dropped_before_air = port.before_air,
          .lost_below_floor = air.lost_below_floor,
          .lost_below_detection = air.lost_below_detection,
          .lost_noise = air.lost_noise,
          .lost_collision = air.lost_collision,
          .lost_interference = air.lost_interference,
          .lost_half_duplex = air.lost_half_duplex,
          .lost_jammed = air.lost_jammed,
          .lost_interface = port.lost_interface};
}

void LiveAir::publish(std::uint32_t first, std::uint32_t count) {
  if (!radio_memory_) {
    return;
  }
  const std::uint32_t end = std::min(first + count, air_->node_count());
  for (std::uint32_t node = first; node < end; ++node) {
    radio_memory_->publish(node, tally(node));
  }
}

void LiveAir::publish_timing() {
  if (!radio_memory_) {
    return;
  }
  radio_memory_->publish({.release_lateness_p50_ns = release_lateness_.quantile_ns(0.5),
                          .release_lateness_p99_ns = release_lateness_.quantile_ns(0.99),
                          .release_lateness_max_ns = release_lateness_.max_ns(),
                          .releases = release_lateness_.count(),
                          .clamps = clamp_.count(),
                          .events = air_->events()});
  radio_memory_->beat(to_ns(air_->now()));
}

proto::RadioReport LiveAir::report() const {
  proto::RadioReport report;
  report.set_send_stamps(stamps_ ? "tc-bpf" : "read");
  report.set_scheduler(scheduler_);
  *report.mutable_ingress_delay() = ipc::summary_of(ingress_delay_);
  *report.mutable_release_lateness() = ipc::summary_of(release_lateness_);
  report.set_clamps(clamp_.count());
  *report.mutable_clamp() = ipc::summary_of(clamp_);
  report.set_events(air_->events());
  report.set_cpu_s(cpu_s_);
  std::uint64_t before_air = 0;
  for (std::uint32_t node = 0; node < air_->node_count(); ++node) {
    before_air += ports_[node].before_air;
  }
  report.set_lost_before_air(before_air);
  report.set_unstamped(unstamped_);
  report.set_frames_not_logged(not_logged_);
  report.set_receptions_not_logged(receptions_not_logged_);
  if (recorder_ && recorder_->captures() != nullptr) {
    report.set_packets_captured(recorder_->captures()->packets());
    report.set_packets_not_captured(recorder_->captures()->packets_left_out());
  }
  if (recorder_ && recorder_->monitors() != nullptr) {
    report.set_packets_monitored(recorder_->monitors()->packets());
    report.set_packets_not_monitored(recorder_->monitors()->packets_left_out());
  }
  return report;
}

proto::NodeServiceReport LiveAir::service_report(std::uint32_t node) const {
  const Port& port = ports_[node];
  proto::NodeServiceReport report;
  report.set_queue_high_water(static_cast<std::uint32_t>(port.most_outstanding));
  report.set_clamps(port.clamps);
  report.set_releases(port.releases);
  report.set_late_releases(port.late_releases);
  report.set_release_lateness_max_ns(port.release_lateness_max_ns);
  return report;
}

}  // namespace cuscus::netsim
