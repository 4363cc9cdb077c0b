#include "orchestrator/plan/plan.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "common/scenario/names.h"
#include "common/scenario/placeholders.h"
#include "orchestrator/plan/camera_configuration.h"
#include "orchestrator/plan/capacity.h"
#include "orchestrator/plan/radio_configuration.h"
#include "orchestrator/plan/world_configuration.h"

namespace cuscus::orchestrator {
namespace {

using scenario::Group;
using scenario::Scenario;

// SCHED_FIFO priorities: who must not wait for whom. The emulator decides what the air does when,
// the world decides where everybody is, agents react to both.
constexpr std::int32_t kRadioPriority = 60;
constexpr std::int32_t kWorldPriority = 50;
constexpr std::int32_t kAgentPriority = 40;

std::int32_t priority(const Scenario& scenario, std::int32_t wanted) {
  return scenario.realtime ? wanted : 0;
}

/// Locally administered (bit 1 of the first octet), "cus" and the node's number from 1.
std::array<std::uint8_t, 6> mac_of(std::uint32_t node) {
  const std::uint32_t number = node + 1;
  return {0x02,
          0x63,
          0x75,
          0x73,
          static_cast<std::uint8_t>(number >> 8U),
          static_cast<std::uint8_t>(number)};
}

proto::CircleMission mission_of(const scenario::CircleMission& circle) {
  proto::CircleMission mission;
  *mission.mutable_p_wc_centre_m() =
      vector_of({circle.centre_m[0], circle.centre_m[1], circle.altitude_m});
  mission.set_radius_m(circle.radius_m);
  mission.set_speed_mps(circle.speed_mps);
  mission.set_spacing_gain(circle.spacing_gain);
  return mission;
}

/// Builds the plan node by node.
class Planner {
 public:
  explicit Planner(const Scenario& scenario) : scenario_{scenario} {}

  Plan make() {
    plan_run();
    std::uint32_t first_node = 0;
    for (const Group& group : scenario_.fleet) {
      plan_group(group, first_node);
      first_node += group.count;
    }
    if (scenario_.ground_station.enabled) {
      plan_ground_station();
    }
    plan_hosts();
    plan_.world = world_configuration(scenario_, plan_.nodes);
    plan_.world.set_realtime_priority(priority(scenario_, kWorldPriority));
    plan_.cameras = camera_configuration(scenario_, plan_.nodes);
    plan_radio();
    plan_.capacity = estimate_capacity(scenario_);
    return std::move(plan_);
  }

 private:
  void plan_run() {
    plan_.scenario_name = scenario_.name;
    plan_.seed = scenario_.seed;
    plan_.duration = scenario_.duration;
    plan_.realtime = scenario_.realtime;
    plan_.on_late = scenario_.on_late;
    plan_.subnet = scenario_.network.subnet;
    plan_.attach = scenario_.network.attach;
    plan_.static_neighbours = scenario_.network.neighbours == scenario::AddressResolution::kStatic;
    plan_.ipv6 = scenario_.network.ipv6;
    plan_.monitor = scenario_.network.monitor;
    plan_.mtu_bytes = scenario_.network.mtu_bytes;
    plan_.record_frames = scenario_.record.frames;
    plan_.record_receptions = scenario_.record.receptions;
    plan_.metrics_period = scenario_.record.metrics_period;
    if (scenario_.ground_station.enabled) {
      plan_.page_port = scenario_.ground_station.page_port;
    }
  }

  NodePlan node(std::string name, NodeRole role, const scenario::Position_m& p_WB_start_m) const {
    NodePlan node;
    node.index = static_cast<std::uint32_t>(plan_.nodes.size());
    node.name = std::move(name);
    node.role = role;
    node.ip = address_of(node.index);
    node.mac = mac_of(node.index);
    node.interface = "wlan0";
    node.tap = fmt::format("tap{}", node.index);
    if (plan_.attach == scenario::Attach::kBridge) {
      node.bridge = fmt::format("br{}", node.index);
      node.veth = fmt::format("veth{}", node.index);
    }
    node.p_WB_start_m = p_WB_start_m;
    return node;
  }

  void plan_group(const Group& group, std::uint32_t first_node) {
    const auto positions = start_positions(group);
    for (std::uint32_t member = 0; member < group.count; ++member) {
      NodePlan uav = node(uav_name(group, member),
                          group.is_fixed() ? NodeRole::kFixed : NodeRole::kUav, positions[member]);
      if (group.autopilot) {
        uav.agent = agent_of(group, member, first_node);
        uav.sees_motion_capture =
            group.neighbours.source == scenario::NeighbourSource::kMotionCapture;
        plan_.motion_capture_memory = plan_.motion_capture_memory || uav.sees_motion_capture;
        uav.programs.push_back(agent_program_of(group, member, uav));
      }
      if (!group.command.empty()) {
        Program command = brought_program(group, group.command, member, uav);
        command.kind = ProgramKind::kCommand;
        command.capabilities = group.capabilities;
        command.log_name = uav.name + "-command.log";
        uav.programs.push_back(std::move(command));
      }
      plan_.nodes.push_back(std::move(uav));
    }
  }

  proto::AgentConfiguration agent_of(const Group& group, std::uint32_t member,
                                     std::uint32_t first_node) const {
    proto::AgentConfiguration agent;
    agent.set_node(first_node + member);
    agent.set_name(uav_name(group, member));
    agent.set_slot(member);
    agent.set_fleet_size(group.count);
    agent.set_seed(scenario_.seed);
    agent.set_control_period_ns(group.control_period.count());
    if (group.mission) {
      *agent.mutable_circle() = mission_of(*group.mission);
    }
    agent.set_neighbours(group.neighbours.source == scenario::NeighbourSource::kBeacons
                             ? proto::AgentConfiguration::NEIGHBOURS_BEACONS
                             : proto::AgentConfiguration::NEIGHBOURS_MOTION_CAPTURE);
    agent.set_beacon_period_ns(group.neighbours.beacon_period.count());
    agent.set_beacon_port(group.neighbours.port);
    agent.set_beacon_address(scenario::ipv4_text(scenario_.network.subnet.broadcast()));
    agent.set_neighbour_timeout_ns(group.neighbours.timeout.count());
    if (scenario_.ground_station.enabled) {
      agent.set_telemetry_address(address_of(scenario_.uav_count()));
      agent.set_telemetry_port(scenario_.ground_station.telemetry_port);
      agent.set_telemetry_period_ns(group.telemetry_period.count());
    }
    if (const auto* x4 = std::get_if<scenario::X4Vehicle>(&group.vehicle)) {
      *agent.mutable_multirotor() = parameters_of(*x4);
    }
    for (std::uint32_t slot = 0; slot < group.count; ++slot) {
      agent.add_slot_nodes(first_node + slot);
    }
    agent.set_gravity_mps2(scenario_.world.gravity_mps2);
    agent.set_motion_capture_noise_m(scenario_.world.motion_capture_noise_m);
    agent.set_realtime_priority(priority(scenario_, kAgentPriority));
    return agent;
  }

  Program agent_program_of(const Group& group, std::uint32_t member, const NodePlan& uav) const {
    Program program;
    if (group.agent.empty()) {
      program.arguments = {"cuscus-agent"};
      program.environment = environment_of(uav);
      program.on_exit = group.on_exit;
    } else {
      program = brought_program(group, group.agent, member, uav);
    }
    program.kind = ProgramKind::kAgent;
    program.has_control_socket = true;
    program.log_name = uav.name + "-agent.log";
    return program;
  }

  /// What the scenario brings for a UAV, with placeholders filled in.
  Program brought_program(const Group& group, const std::vector<std::string>& arguments,
                          std::uint32_t member, const NodePlan& uav) const {
    scenario::PlaceholderValues values;
    values.index = std::to_string(member);
    values.count = std::to_string(group.count);
    values.name = uav.name;
    values.group = group.name;
    values.ip = uav.ip;
    if (scenario_.ground_station.enabled) {
      values.gcs_ip = address_of(scenario_.uav_count());
    }
    values.broadcast = scenario::ipv4_text(scenario_.network.subnet.broadcast());
    values.scenario_dir = scenario_.folder.string();
    values.ip_of = [this](const std::string& name) { return address_of_name(name); };

    Program program;
    program.from_scenario = true;
    for (const std::string& argument : arguments) {
      program.arguments.push_back(expand(argument, values));
    }
    program.environment = environment_of(uav);
    for (const auto& [name, text] : group.environment) {
      const std::string prefix = name + '=';
      std::erase_if(program.environment,
                    [&prefix](const std::string& entry) { return entry.starts_with(prefix); });
      program.environment.push_back(prefix + expand(text, values));
    }
    program.on_exit = group.on_exit;
    program.working_directory = scenario_.folder.string();
    return program;
  }

  void plan_ground_station() {
    NodePlan gcs = node(std::string{scenario::kGroundStationName}, NodeRole::kGroundStation,
                        scenario_.ground_station.position_m);
    gcs.programs.push_back({.kind = ProgramKind::kGroundStation,
                            .arguments = {"cuscus-gcs"},
                            .environment = environment_of(gcs),
                            .capabilities = {},
                            .on_exit = scenario::OnExit::kFail,
                            .has_control_socket = true,
                            .log_name = gcs.name + ".log"});
    proto::GroundStationConfiguration configuration;
    configuration.set_node(gcs.index);
    configuration.set_telemetry_port(scenario_.ground_station.telemetry_port);
    configuration.set_scenario_name(scenario_.name);
    configuration.set_duration_ns(scenario_.duration.count());
    plan_.nodes.push_back(std::move(gcs));
    for (const NodePlan& node : plan_.nodes) {
      proto::GroundStationNode& entry = *configuration.add_nodes();
      entry.set_node(node.index);
      entry.set_name(node.name);
      entry.set_address(node.ip);
      entry.set_is_vehicle(node.role == NodeRole::kUav);
      if (node.agent) {
        entry.set_telemetry_period_ns(node.agent->telemetry_period_ns());
      }
    }
    for (const Group& group : scenario_.fleet) {
      if (group.mission && !configuration.has_circle()) {
        *configuration.mutable_circle() = mission_of(*group.mission);
      }
    }
    plan_.ground_station = std::move(configuration);
  }

  void plan_hosts() {
    if (scenario_.network.hosts) {
      for (const NodePlan& node : plan_.nodes) {
        plan_.hosts.push_back({.ip = node.ip, .name = node.name});
      }
    }
  }

  void plan_radio() {
    const scenario::Radio& from = scenario_.radio;
    plan_.radio = radio_configuration(from, scenario_.seed);
    proto::RadioConfiguration& radio = plan_.radio;
    radio.set_realtime_priority(priority(scenario_, kRadioPriority));
    radio.set_bridge(plan_.attach == scenario::Attach::kBridge);
    for (const NodePlan& node : plan_.nodes) {
      proto::RadioNode& entry = *radio.add_nodes();
      entry.set_node(node.index);
      entry.set_name(node.name);
      entry.set_mac(std::string{node.mac.begin(), node.mac.end()});
      entry.set_tx_power_dbm(from.tx_power.value);
      entry.set_antenna_gain_db(from.antenna_gain.value);
    }
    plan_slots();
    plan_captures();
  }

  void plan_captures() {
    const scenario::Captures& captures = scenario_.record.captures;
    for (const NodePlan& node : plan_.nodes) {
      if (captures.everyone ||
          std::ranges::find(captures.nodes, node.name) != captures.nodes.end()) {
        plan_.captured_nodes.push_back(node.index);
      }
    }
    plan_.radio.set_capture_snap_length(captures.snap_length_bytes.value_or(0));
    plan_.radio.set_capture_failed(captures.failed_receptions);
  }

  void plan_slots() {
    constexpr std::int32_t kNobody = -2;
    const auto* const tdma = std::get_if<scenario::TdmaMac>(&scenario_.radio.mac);
    if (tdma == nullptr) {
      return;
    }
    std::map<std::string, std::int32_t> numbers{{std::string{scenario::kNoOwner}, kNobody}};
    for (const NodePlan& node : plan_.nodes) {
      numbers[node.name] = static_cast<std::int32_t>(node.index);
    }
    for (const std::string& owner : tdma->frame) {
      plan_.radio.mutable_tdma()->add_frame(numbers.at(owner));
    }
  }

  std::string address_of(std::uint32_t node) const {
    return scenario::ipv4_text(scenario_.network.subnet.host(node));
  }

  std::optional<std::string> address_of_name(const std::string& name) const {
    std::uint32_t node = 0;
    for (const Group& group : scenario_.fleet) {
      for (std::uint32_t member = 0; member < group.count; ++member, ++node) {
        if (uav_name(group, member) == name) {
          return address_of(node);
        }
      }
    }
    if (scenario_.ground_station.enabled && name == scenario::kGroundStationName) {
      return address_of(node);
    }
    return std::nullopt;
  }

  std::vector<std::string> environment_of(const NodePlan& node) const {
    std::vector<std::string> environment{
        "PATH=" + std::string{kProgramPath},
        "LANG=C.UTF-8",
        "CUSCUS_NODE=" + std::to_string(node.index),
        "CUSCUS_NAME=" + node.name,
        "CUSCUS_IP=" + node.ip,
    };
    if (scenario_.ground_station.enabled) {
      environment.push_back("CUSCUS_GCS_IP=" + address_of(scenario_.uav_count()));
    }
    return environment;
  }

  const Scenario& scenario_;
  Plan plan_;
};

}  // namespace

Plan make_plan(const Scenario& scenario) { return Planner{scenario}.make(); }

std::string mac_text(const std::array<std::uint8_t, 6>& mac) {
  return fmt::format("{:02x}:{:02x}:{:02x}:{:02x}:{:02x}:{:02x}", mac[0], mac[1], mac[2], mac[3],
                     mac[4], mac[5]);
}

}  // namespace cuscus::orchestrator
