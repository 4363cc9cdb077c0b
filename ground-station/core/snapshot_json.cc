#include <algorithm>
#include <cmath>

#include "ground-station/core/json_writer.h"
#include "ground-station/core/snapshot.h"

namespace cuscus::gcs {
namespace {

constexpr int kMillimetres = 3;     // decimals of metres, seconds, radians
constexpr int kPerTenThousand = 4;  // of ratios
constexpr int kTenths = 1;          // of microseconds, decibels and Mb/s
constexpr double kMegabit_kbit = 1e3;
constexpr double kMicrosecond_ns = 1e3;

std::string_view name_of(RunState state) {
  switch (state) {
    case RunState::kStarting:
      return "starting";
    case RunState::kRunning:
      return "running";
    case RunState::kEnded:
      break;
  }
  return "ended";
}

void field(JsonWriter& json, std::string_view name, std::uint64_t value) {
  json.key(name);
  json.integer(value);
}

void field(JsonWriter& json, std::string_view name, double value, int decimals) {
  json.key(name);
  json.number(value, decimals);
}

void field(JsonWriter& json, std::string_view name, const std::string& value) {
  json.key(name);
  json.string(value);
}

void flag(JsonWriter& json, std::string_view name, bool value) {
  json.key(name);
  json.boolean(value);
}

void field(JsonWriter& json, std::string_view name, const std::array<double, 3>& vector) {
  json.key(name);
  json.begin_array();
  for (const double component : vector) {
    json.number(component, kMillimetres);
  }
  json.end_array();
}

double age_s(SimTime now, SimTime then) { return std::max(0.0, to_seconds(now - then)); }

/// Writes `value` with `write`, or null when there is none.
template <typename Optional, typename Write>
void optional_object(JsonWriter& json, std::string_view name, const Optional& value, Write write) {
  json.key(name);
  if (!value) {
    json.null();
    return;
  }
  json.begin_object();
  write(*value);
  json.end_object();
}

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

void write(JsonWriter& json, const Snapshot::Telemetry& telemetry) {
  const TelemetrySample& sample = telemetry.sample;
  field(json, "at_s", to_seconds(sample.at.time_since_epoch()), kMillimetres);
  field(json, "p_m", sample.p_WB_m);
  field(json, "v_mps", sample.v_WB_W_mps);
  field(json, "speed_mps", norm(sample.v_WB_W_mps), kMillimetres);
  field(json, "yaw_rad", sample.yaw_rad, kMillimetres);
  field(json, "state", sample.state);
  field(json, "neighbours_heard", sample.neighbours_heard);
  field(json, "age_s", std::max(0.0, to_seconds(telemetry.age)), kMillimetres);
  field(json, "received", telemetry.received);
  field(json, "loss", telemetry.loss_ratio, kPerTenThousand);
  field(json, "recent_loss", telemetry.recent_loss_ratio, kPerTenThousand);
}

void write(JsonWriter& json, const Observation::Truth& truth) {
  field(json, "p_m", truth.p_WB_m);
  field(json, "v_mps", truth.v_WB_W_mps);
  field(json, "speed_mps", norm(truth.v_WB_W_mps), kMillimetres);
  field(json, "yaw_rad", truth.yaw_rad, kMillimetres);
  flag(json, "on_ground", truth.on_ground);
  flag(json, "motors_running", truth.motors_running);
}

void write(JsonWriter& json, const shm::RadioTally& tally) {
  field(json, "offered", tally.offered);
  field(json, "transmissions", tally.transmissions);
  field(json, "retries", tally.retries);
  field(json, "acknowledged", tally.acknowledged);
  field(json, "received", tally.received);
  json.key("dropped");
  json.begin_object();
  field(json, "queue_full", tally.dropped_queue_full);
  field(json, "lifetime", tally.dropped_lifetime);
  field(json, "retry_limit", tally.dropped_retry_limit);
  field(json, "malformed", tally.dropped_malformed);
  field(json, "before_air", tally.dropped_before_air);
  json.end_object();
  json.key("lost");
  json.begin_object();
  field(json, "below_floor", tally.lost_below_floor);
  field(json, "below_detection", tally.lost_below_detection);
  field(json, "noise", tally.lost_noise);
  field(json, "collision", tally.lost_collision);
  field(json, "interference", tally.lost_interference);
  field(json, "half_duplex", tally.lost_half_duplex);
  field(json, "jammed", tally.lost_jammed);
  field(json, "interface", tally.lost_interface);
  json.end_object();
}

void write(JsonWriter& json, const Snapshot::Node& node) {
  json.begin_object();
  field(json, "node", node.node);
  field(json, "name", node.name);
  field(json, "address", node.address);
  flag(json, "vehicle", node.is_vehicle);
  field(json, "telemetry_period_s", to_seconds(node.telemetry_period), kMillimetres);
  field(json, "hears", node.hears);
  const auto whole = [&](const auto& part) { write(json, part); };
  optional_object(json, "telemetry", node.telemetry, whole);
  optional_object(json, "truth", node.truth, whole);
  optional_object(json, "radio", node.radio, whole);
  json.end_object();
}

void write_timing(JsonWriter& json, const shm::RadioTiming& timing) {
  const auto microseconds = [](std::int64_t nanoseconds) {
    return static_cast<double>(nanoseconds) / kMicrosecond_ns;
  };
  field(json, "p50", microseconds(timing.release_lateness_p50_ns), kTenths);
  field(json, "p99", microseconds(timing.release_lateness_p99_ns), kTenths);
  field(json, "max", microseconds(timing.release_lateness_max_ns), kTenths);
  field(json, "releases", timing.releases);
  field(json, "clamps", timing.clamps);
}

void write_run(JsonWriter& json, const Snapshot& snapshot) {
  json.key("run");
  json.begin_object();
  field(json, "id", snapshot.run_id);
  field(json, "scenario", snapshot.scenario_name);
  field(json, "state", std::string{name_of(snapshot.state)});
  field(json, "sim_time_s", to_seconds(snapshot.now.time_since_epoch()), kMillimetres);
  field(json, "duration_s", to_seconds(snapshot.duration), kMillimetres);
  optional_object(json, "world", snapshot.world, [&](const Observation::World& world) {
    field(json, "steps", world.steps);
    field(json, "overruns", world.overruns);
    field(json, "heartbeat_age_s", age_s(snapshot.now, world.reached), kMillimetres);
  });
  optional_object(json, "radio", snapshot.radio, [&](const Observation::Radio& radio) {
    field(json, "heartbeat_age_s", age_s(snapshot.now, radio.reached), kMillimetres);
    optional_object(json, "lateness_us", radio.timing,
                    [&](const shm::RadioTiming& timing) { write_timing(json, timing); });
  });
  json.key("telemetry");
  json.begin_object();
  field(json, "received", snapshot.telemetry_received);
  field(json, "rejected", snapshot.telemetry_rejected);
  json.end_object();
  json.end_object();
}

void write_links(JsonWriter& json, const Snapshot& snapshot) {
  json.key("links");
  json.begin_array();
  for (const Snapshot::Link& link : snapshot.links) {
    json.begin_array();
    json.integer(link.a);
    json.integer(link.b);
    json.number(link.received_dbm, kTenths);
    json.number(std::max(0.0, to_seconds(link.age)), kMillimetres);
    json.boolean(link.one_way);
    json.number(static_cast<double>(link.rate_kbps) / kMegabit_kbit, kTenths);
    json.end_array();
  }
  json.end_array();
  field(json, "links_left_out", snapshot.links_left_out);
}

}  // namespace

std::string to_json(const Snapshot& snapshot) {
  constexpr std::size_t kNode_bytes = 1100;
  constexpr std::size_t kLink_bytes = 35;
  JsonWriter json;
  json.reserve(kNode_bytes * (snapshot.nodes.size() + 1) + kLink_bytes * snapshot.links.size());
  json.begin_object();
  field(json, "version", std::uint64_t{2});
  write_run(json, snapshot);
  optional_object(json, "circle", snapshot.circle, [&](const Snapshot::Circle& circle) {
    field(json, "centre_m", circle.p_WC_centre_m);
    field(json, "radius_m", circle.radius_m, kMillimetres);
  });
  json.key("nodes");
  json.begin_array();
  for (const Snapshot::Node& node : snapshot.nodes) {
    write(json, node);
  }
  json.end_array();
  write_links(json, snapshot);
  json.end_object();
  return std::move(json).take();
}

}  // namespace cuscus::gcs
