#include "orchestrator/plan/capacity.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace cuscus::orchestrator {
namespace {

using scenario::airtime_s;
using scenario::Attach;
using scenario::NeighbourSource;
using scenario::psdu_airtime_s;
using scenario::psdu_bytes;

// Processor time, measured. A copy through bridge and veth costs about twice a direct one; a
// spinning MAC thread sleeps except for the last 150 us before an event.
constexpr double kDirectCopy_s = 3e-6;
constexpr double kBridgeCopy_s = 6e-6;
constexpr double kFrame_s = 10e-6;
constexpr double kWaiting_cores = 0.14;
constexpr double kWorldStep_s = 0.6e-6;   // per UAV: RK4 with sensors
constexpr double kControlLoop_s = 15e-6;  // per loop: wake, estimate, control, publish

// Our datagrams with IP and UDP headers: proto/air.proto keeps a beacon below 100 B.
constexpr std::uint32_t kBeacon_bytes = 80 + 28;
constexpr std::uint32_t kTelemetry_bytes = 70 + 28;

double seconds(scenario::Duration duration) { return to_seconds(duration); }

double sifs_s(scenario::RadioStandard standard) {
  switch (standard) {
    case scenario::RadioStandard::k80211a:
      return 16e-6;
    case scenario::RadioStandard::k80211p:
      return 32e-6;
    default:
      return 10e-6;
  }
}

/// DIFS and the mean of the first backoff, of 0 ... 15 slots (802.11b: 31), or those of EDCA's best
/// effort; TDMA and the ideal air have neither.
double contention_s(const scenario::Radio& radio) {
  if (!acknowledges(radio.mac)) {
    return 0.0;
  }
  if (const auto* edca = std::get_if<scenario::EdcaMac>(&radio.mac)) {
    return sifs_s(radio.standard) +
           (edca->best_effort.aifsn + edca->best_effort.cw_min / 2.0) * seconds(radio.slot);
  }
  const double mean_backoff_slots = radio.standard == scenario::RadioStandard::k80211b ? 15.5 : 7.5;
  return sifs_s(radio.standard) + (2.0 + mean_backoff_slots) * seconds(radio.slot);
}

/// RTS and CTS at the lowest basic rate, with SIFS after each, before a frame above the threshold.
double announcement_s(const scenario::Radio& radio, std::uint32_t ip_bytes) {
  constexpr std::uint32_t kRts_bytes = 20;
  constexpr std::uint32_t kCts_bytes = 14;
  if (!acknowledges(radio.mac) || !radio.rts_threshold_bytes ||
      psdu_bytes(radio, ip_bytes) <= *radio.rts_threshold_bytes) {
    return 0.0;
  }
  const std::uint32_t rate_kbps = radio.basic_rates_kbps.front();
  return psdu_airtime_s(radio, kRts_bytes, rate_kbps) +
         psdu_airtime_s(radio, kCts_bytes, rate_kbps) + 2.0 * sifs_s(radio.standard);
}

}  // namespace

CapacityEstimate estimate_capacity(const scenario::Scenario& scenario) {
  const double others = scenario.node_count() - 1.0;
  const scenario::Radio& radio = scenario.radio;
  constexpr std::uint32_t kAck_bytes = 14;
  const double ack_s = acknowledges(radio.mac)
                           ? sifs_s(radio.standard) +
                                 psdu_airtime_s(radio, kAck_bytes, radio.basic_rates_kbps.front())
                           : 0.0;
  const double telemetry_s = airtime_s(radio, kTelemetry_bytes, radio.data_rate_kbps) + ack_s +
                             announcement_s(radio, kTelemetry_bytes);
  CapacityEstimate estimate;
  double loops_per_s = 0.0;
  double vehicles = 0.0;
  for (const scenario::Group& group : scenario.fleet) {
    vehicles += group.is_fixed() ? 0.0 : group.count;
    if (!group.autopilot) {
      continue;
    }
    loops_per_s += group.count / seconds(group.control_period);
    if (group.neighbours.source == NeighbourSource::kBeacons) {
      const double beacons_per_s = group.count / seconds(group.neighbours.beacon_period);
      estimate.frames_per_s += beacons_per_s;
      estimate.copies_per_s += beacons_per_s * others;
      estimate.air_busy_fraction +=
          beacons_per_s *
          (contention_s(radio) + airtime_s(radio, kBeacon_bytes, radio.group_rate_kbps));
    }
    if (scenario.ground_station.enabled) {
      const double reports_per_s = group.count / seconds(group.telemetry_period);
      estimate.frames_per_s += reports_per_s;
      estimate.copies_per_s += reports_per_s;
      estimate.air_busy_fraction += reports_per_s * (contention_s(radio) + telemetry_s);
    }
  }
  const double copy_s = scenario.network.attach == Attach::kDirect ? kDirectCopy_s : kBridgeCopy_s;
  estimate.emulator_cores =
      kWaiting_cores + estimate.frames_per_s * kFrame_s + estimate.copies_per_s * copy_s;
  estimate.world_cores = vehicles * kWorldStep_s / seconds(scenario.world.step);
  estimate.agent_cores = loops_per_s * kControlLoop_s;

  constexpr double kFullAir = 0.7;  // contention makes delays grow well before 1
  if (estimate.air_busy_fraction > kFullAir) {
    estimate.warnings.push_back(fmt::format(
        "beacons and telemetry would keep the air busy {:.0f} % of the time: expect long queues "
        "and collisions; a longer beacon_period or a higher group_rate helps",
        100.0 * estimate.air_busy_fraction));
  }
  if (estimate.emulator_cores > 1.0) {
    estimate.warnings.push_back(fmt::format(
        "the emulator needs about {:.1f} cores{}: expect frames to be released late unless the "
        "host is fast",
        estimate.emulator_cores,
        scenario.network.attach == Attach::kBridge ? " (\"attach\": \"direct\" halves it)" : ""));
  }
  if (estimate.world_cores > 1.0) {
    estimate.warnings.push_back(fmt::format(
        "the world needs about {:.1f} cores: a longer world.step helps", estimate.world_cores));
  }
  return estimate;
}

}  // namespace cuscus::orchestrator
