#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/scenario/scenario.h"
#include "proto/configuration.pb.h"

/// Everything that a run will create, as data: `cuscus check` prints it, `cuscus run` carries it
/// out.
namespace cuscus::orchestrator {

enum class ProgramKind { kAgent, kGroundStation, kCommand };

/// A program to be started in a node.
struct Program {
  ProgramKind kind{ProgramKind::kCommand};
  /// The scenario brings it: arguments[0] is an absolute path, or a name to be searched in PATH.
  /// Otherwise it is "cuscus-agent" or "cuscus-gcs", which lie beside `cuscus`.
  bool from_scenario{false};
  std::vector<std::string> arguments;
  std::vector<std::string> environment;   ///< KEY=VALUE, complete but for CUSCUS_CONTROL_FD.
  std::vector<std::string> capabilities;  ///< "cap_net_raw"
  /// Of what the scenario brings: its folder; of our own programs: empty, which is "/".
  std::string working_directory{};
  scenario::OnExit on_exit{scenario::OnExit::kFail};
  bool has_control_socket{false};
  std::string log_name;  ///< File in the run directory's logs/ for its output: "uav3-command.log".
};

enum class NodeRole { kUav, kFixed, kGroundStation };

/// A radio node: a set of namespaces with one interface.
struct NodePlan {
  std::uint32_t index{};  ///< Radio node number, slot in fleet memory.
  std::string name;       ///< "uav3", "gcs"; also the host name.
  NodeRole role{NodeRole::kUav};
  std::string ip;
  std::array<std::uint8_t, 6> mac{};
  std::string interface;  ///< In the node's own namespace: "wlan0".
  // In the fabric namespace; with Attach::kDirect the TAP moves to the node as `interface`, and
  // there is no bridge.
  std::string tap;
  std::string bridge;
  std::string veth;
  scenario::Position_m p_WB_start_m{};
  std::vector<Program> programs;
  /// For the agent among `programs`; nothing when there is none.
  std::optional<proto::AgentConfiguration> agent;
  /// The agent gets motion-capture memory.
  bool sees_motion_capture{false};
};

/// A line of every node's /etc/hosts.
struct Host {
  std::string ip;
  std::string name;
};

/// What the traffic of our own programs will cost; own commands come on top.
struct CapacityEstimate {
  double frames_per_s{};       ///< Frames handed to the radio.
  double copies_per_s{};       ///< Frames written to receivers' interfaces.
  double air_busy_fraction{};  ///< Of the time, with all nodes in range of one another.
  double emulator_cores{};     ///< Processor cores that netsim needs.
  double world_cores{};
  double agent_cores{};
  std::vector<std::string> warnings;
};

struct Plan {
  std::string scenario_name;
  std::uint64_t seed{};
  scenario::Duration duration{};
  bool realtime{};
  scenario::OnLate on_late{};
  scenario::Subnet subnet;
  scenario::Attach attach{};
  bool static_neighbours{};  ///< Permanent neighbour entries instead of ARP on the air.
  bool ipv6{};
  bool monitor{};  ///< mon0 of every node is up from the start.
  std::uint32_t mtu_bytes{};
  std::vector<Host> hosts;  ///< Empty: names are not wanted.
  /// In the order of their indices: UAVs and fixed nodes as in the fleet, then the ground station.
  std::vector<NodePlan> nodes;
  proto::WorldConfiguration world;
  proto::RadioConfiguration radio;
  /// run_id is empty: the run fills it in.
  std::optional<proto::GroundStationConfiguration> ground_station;
  /// Nothing when no vehicle has a camera.
  std::optional<proto::CameraConfiguration> cameras;
  std::optional<std::uint16_t> page_port;  ///< On 127.0.0.1, when there is a page.
  bool motion_capture_memory{};            ///< Some agent needs it.
  bool record_frames{};
  bool record_receptions{};
  std::vector<std::uint32_t> captured_nodes;
  scenario::Duration metrics_period{};
  CapacityEstimate capacity;
};

/// PATH of every program in a node.
inline constexpr std::string_view kProgramPath =
    "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin";

/// The plan of `scenario`, which has been checked.
[[nodiscard]] Plan make_plan(const scenario::Scenario& scenario);

/// The plan for `cuscus check --json`.
[[nodiscard]] nlohmann::ordered_json to_json(const Plan& plan);

/// The plan for a person, in lines that end with '\n'.
[[nodiscard]] std::string to_text(const Plan& plan);

/// "uav", "fixed", "ground-station"
[[nodiscard]] std::string name_of(NodeRole role);

/// "agent", "ground-station", "command"
[[nodiscard]] std::string name_of(ProgramKind kind);

/// "02:63:75:73:00:01"
[[nodiscard]] std::string mac_text(const std::array<std::uint8_t, 6>& mac);

}  // namespace cuscus::orchestrator
