#include "ground-station/core/fleet_picture.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "ground-station/core/link_picture.h"

namespace cuscus::gcs {
namespace {

/// Element `index` of `items`, nothing beyond their end.
template <typename T>
std::optional<T> element(const std::vector<std::optional<T>>& items, std::uint32_t index) {
  return index < items.size() ? items[index] : std::nullopt;
}

}  // namespace

FleetPicture::FleetPicture(const proto::GroundStationConfiguration& configuration)
    : configuration_{configuration} {
  std::set<std::uint32_t> numbers;
  for (const proto::GroundStationNode& node : configuration_.nodes()) {
    if (!numbers.insert(node.node()).second) {
      throw std::invalid_argument{"ground station configuration: node " +
                                  std::to_string(node.node()) + " is there twice"};
    }
    if (node.is_vehicle()) {
      vehicles_.try_emplace(node.node());
    }
  }
}

bool FleetPicture::reject(TelemetryFault fault) noexcept {
  ++rejected_[static_cast<std::size_t>(fault)];
  return false;
}

std::uint64_t FleetPicture::rejected() const noexcept {
  return std::accumulate(rejected_.begin(), rejected_.end(), std::uint64_t{0});
}

bool FleetPicture::receive(std::span<const std::byte> datagram, SimTime now) {
  auto decoded = decode_telemetry(datagram, now);
  if (const auto* const fault = std::get_if<TelemetryFault>(&decoded)) {
    return reject(*fault);
  }
  auto& sample = std::get<TelemetrySample>(decoded);
  const auto found = vehicles_.find(sample.node);
  if (found == vehicles_.end()) {
    return reject(TelemetryFault::kUnknownNode);
  }
  ++received_;
  Vehicle& vehicle = found->second;
  if (vehicle.tally.count(sample.sequence, sample.at) == SequenceTally::Arrival::kNewest) {
    vehicle.latest = std::move(sample);
  }
  return true;
}

Snapshot FleetPicture::snapshot(const Observation& observation, SimTime now, RunState state) const {
  Snapshot result{};
  result.run_id = configuration_.run_id();
  result.scenario_name = configuration_.scenario_name();
  result.state = state;
  result.now = now;
  result.duration = SimClock::duration{configuration_.duration_ns()};
  if (configuration_.has_circle()) {
    const proto::CircleMission& circle = configuration_.circle();
    const proto::Vector3& centre = circle.p_wc_centre_m();
    result.circle = {.p_WC_centre_m = {centre.x(), centre.y(), centre.z()},
                     .radius_m = circle.radius_m()};
  }
  LinkPicture links = link_picture(observation, now, kMostLinks);
  for (const proto::GroundStationNode& node : configuration_.nodes()) {
    Snapshot::Node& shown = result.nodes.emplace_back();
    shown.node = node.node();
    shown.name = node.name();
    shown.address = node.address();
    shown.is_vehicle = node.is_vehicle();
    shown.telemetry_period = SimClock::duration{node.telemetry_period_ns()};
    shown.hears = node.node() < links.hears.size() ? links.hears[node.node()] : 0;
    shown.truth = element(observation.truth, node.node());
    shown.radio = element(observation.tallies, node.node());
    const auto found = vehicles_.find(node.node());
    if (found != vehicles_.end() && found->second.latest) {
      const Vehicle& vehicle = found->second;
      shown.telemetry = {.sample = *vehicle.latest,
                         .age = now - vehicle.latest->at,
                         .received = vehicle.tally.received(),
                         .loss_ratio = vehicle.tally.loss_ratio(),
                         .recent_loss_ratio = vehicle.tally.recent_loss_ratio()};
    }
  }
  result.links = std::move(links.strongest);
  result.links_left_out = links.left_out;
  result.world = observation.world;
  result.radio = observation.radio;
  result.telemetry_received = received_;
  result.telemetry_rejected = rejected();
  return result;
}

}  // namespace cuscus::gcs
