#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/units/sim_time.h"
#include "ground-station/core/telemetry.h"
#include "proto/shm/radio_memory.h"

namespace cuscus::gcs {

/// Where a run stands.
enum class RunState : std::uint8_t { kStarting, kRunning, kEnded };

/// What the shared memories said at one instant; index i is node i.
struct Observation {
  struct Truth {
    std::array<double, 3> p_WB_m;
    std::array<double, 3> v_WB_W_mps;
    double yaw_rad;
    bool on_ground;
    bool motors_running;
  };
  struct Link {
    std::uint32_t sender;
    std::uint32_t receiver;
    float received_dbm;
    std::uint32_t rate_kbps;  ///< Of its latest frame.
    SimTime heard;            ///< When that was.
  };
  struct World {
    std::uint64_t steps;
    std::uint64_t overruns;
    SimTime reached;
  };
  struct Radio {
    std::optional<shm::RadioTiming> timing;
    SimTime reached;
  };

  std::vector<std::optional<Truth>> truth;
  std::vector<std::optional<shm::RadioTally>> tallies;
  std::vector<Link> links;
  std::optional<World> world;
  std::optional<Radio> radio;
};

/// All that the page shows, at one instant.
struct Snapshot {
  struct Circle {
    std::array<double, 3> p_WC_centre_m;
    double radius_m;
  };
  struct Telemetry {
    TelemetrySample sample;
    SimClock::duration age;
    std::uint64_t received;
    double loss_ratio;
    double recent_loss_ratio;
  };
  struct Node {
    std::uint32_t node;
    std::string name;
    std::string address;
    bool is_vehicle;
    SimClock::duration telemetry_period;  ///< Of our agent; 0: another program's, or none.
    std::uint32_t hears;                  ///< Nodes heard within the last second.
    std::optional<Telemetry> telemetry;
    std::optional<Observation::Truth> truth;
    std::optional<shm::RadioTally> radio;
  };
  /// Two nodes of which at least one heard the other.
  struct Link {
    std::uint32_t a;  ///< Below b.
    std::uint32_t b;
    double received_dbm;      ///< Of the weaker way.
    std::uint32_t rate_kbps;  ///< Of the latest frame, by the slower way.
    SimClock::duration age;   ///< Of the latest frame.
    bool one_way;             ///< One did not hear the other, although that one has sent frames.
  };

  std::string run_id;
  std::string scenario_name;
  RunState state;
  SimTime now;
  SimClock::duration duration;  ///< 0: until it is stopped.
  std::optional<Circle> circle;
  std::vector<Node> nodes;
  std::vector<Link> links;  ///< Heard within the last second, strongest first.
  std::size_t links_left_out;
  std::optional<Observation::World> world;
  std::optional<Observation::Radio> radio;
  std::uint64_t telemetry_received;
  std::uint64_t telemetry_rejected;
};

/// The JSON text of docs/ground-station.md. Numbers that are not finite become null; all text is
/// escaped so that it may stand in HTML as well.
[[nodiscard]] std::string to_json(const Snapshot& snapshot);

}  // namespace cuscus::gcs
