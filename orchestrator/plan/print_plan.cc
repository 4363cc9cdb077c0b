#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/scenario/names.h"
#include "common/scenario/units.h"
#include "orchestrator/plan/plan.h"

namespace cuscus::orchestrator {
namespace {

using Json = nlohmann::ordered_json;

std::string text(scenario::Duration duration) {
  return scenario::format_quantity(static_cast<double>(duration.count()), scenario::kTime);
}

Json json_of(const Program& program) {
  return {{"kind", name_of(program.kind)},
          {"arguments", program.arguments},
          {"environment", program.environment},
          {"capabilities", program.capabilities},
          {"on_exit", name_of(scenario::kOnExitNames, program.on_exit)},
          {"log", program.log_name}};
}

Json json_of(const NodePlan& node) {
  Json programs = Json::array();
  for (const Program& program : node.programs) {
    programs.push_back(json_of(program));
  }
  Json links{{"interface", node.interface}, {"tap", node.tap}};
  if (!node.bridge.empty()) {
    links["bridge"] = node.bridge;
    links["veth"] = node.veth;
  }
  return {{"index", node.index},          {"name", node.name},
          {"role", name_of(node.role)},   {"ip", node.ip},
          {"mac", mac_text(node.mac)},    {"links", links},
          {"start_m", node.p_WB_start_m}, {"programs", programs}};
}

std::string command_line(const Program& program) {
  std::string line;
  for (const std::string& argument : program.arguments) {
    const bool plain =
        !argument.empty() && argument.find_first_of(" \t\n\"'\\$") == std::string::npos;
    line += (line.empty() ? "" : " ") + (plain ? argument : '\'' + argument + '\'');
  }
  return line;
}

void append_nodes(const Plan& plan, std::string& out) {
  std::size_t width = 4;
  for (const NodePlan& node : plan.nodes) {
    width = std::max(width, node.name.size());
  }
  out += fmt::format("  {:<{}}  {:<15}  {:<17}  {:>24}  programs\n", "node", width, "address",
                     "mac", "start east north up [m]");
  for (const NodePlan& node : plan.nodes) {
    std::string programs;
    for (const Program& program : node.programs) {
      programs += (programs.empty() ? "" : "; ") + command_line(program);
    }
    const auto& p = node.p_WB_start_m;
    out += fmt::format("  {:<{}}  {:<15}  {}  {:>8.1f}{:>8.1f}{:>8.1f}  {}\n", node.name, width,
                       node.ip, mac_text(node.mac), p[0], p[1], p[2],
                       programs.empty() ? "-" : programs);
  }
}

/// Propagation and what else is not as in the default radio.
std::string radio_terms(const proto::RadioConfiguration& radio) {
  std::string out = radio.propagation().model();
  if (radio.propagation().shadowing_db() > 0.0) {
    out += fmt::format(", shadowing {} dB", radio.propagation().shadowing_db());
  }
  if (radio.propagation().fading() != "none") {
    out += ", fading " + radio.propagation().fading();
  }
  if (radio.mac() != "dcf") {
    out += ", " + radio.mac();
  }
  if (radio.antenna() != "isotropic") {
    out += ", antenna " + radio.antenna();
  }
  if (radio.disruption_fraction() > 0.0) {
    out += fmt::format(", disrupted {} % of every {} s", 100.0 * radio.disruption_fraction(),
                       static_cast<double>(radio.disruption_interval_ns()) * 1e-9);
  }
  if (radio.obstacles_size() > 0) {
    out += fmt::format(", {} obstacles", radio.obstacles_size());
  }
  if (radio.jammers_size() > 0) {
    out += fmt::format(", {} jammers", radio.jammers_size());
  }
  if (radio.rate_control() != "constant") {
    out += ", rate control " + radio.rate_control();
  }
  return out;
}

}  // namespace

std::string name_of(NodeRole role) {
  switch (role) {
    case NodeRole::kUav:
      return "uav";
    case NodeRole::kFixed:
      return "fixed";
    case NodeRole::kGroundStation:
      return "ground-station";
  }
  return {};
}

std::string name_of(ProgramKind kind) {
  switch (kind) {
    case ProgramKind::kAgent:
      return "agent";
    case ProgramKind::kGroundStation:
      return "ground-station";
    case ProgramKind::kCommand:
      return "command";
  }
  return {};
}

Json to_json(const Plan& plan) {
  Json nodes = Json::array();
  for (const NodePlan& node : plan.nodes) {
    nodes.push_back(json_of(node));
  }
  const CapacityEstimate& capacity = plan.capacity;
  return {{"scenario", plan.scenario_name},
          {"seed", plan.seed},
          {"duration_s", to_seconds(plan.duration)},
          {"realtime", plan.realtime},
          {"on_late", name_of(scenario::kOnLateNames, plan.on_late)},
          {"subnet", subnet_text(plan.subnet)},
          {"attach", name_of(scenario::kAttachNames, plan.attach)},
          {"static_neighbours", plan.static_neighbours},
          {"ipv6", plan.ipv6},
          {"mtu_bytes", plan.mtu_bytes},
          {"page_port", plan.page_port ? Json(*plan.page_port) : Json(nullptr)},
          {"radio",
           {{"standard", plan.radio.standard()},
            {"data_rate_kbps", plan.radio.data_rate_kbps()},
            {"group_rate_kbps", plan.radio.group_rate_kbps()},
            {"carrier_hz", plan.radio.carrier_hz()},
            {"rate_control", plan.radio.rate_control()},
            {"mac", plan.radio.mac()},
            {"propagation", plan.radio.propagation().model()},
            {"shadowing_db", plan.radio.propagation().shadowing_db()},
            {"fading", plan.radio.propagation().fading()}}},
          {"capacity",
           {{"frames_per_s", capacity.frames_per_s},
            {"copies_per_s", capacity.copies_per_s},
            {"air_busy_fraction", capacity.air_busy_fraction},
            {"emulator_cores", capacity.emulator_cores},
            {"world_cores", capacity.world_cores},
            {"agent_cores", capacity.agent_cores},
            {"warnings", capacity.warnings}}},
          {"nodes", nodes}};
}

std::string to_text(const Plan& plan) {
  std::string out =
      fmt::format("{}: {} for {}, seed {}\n", plan.scenario_name,
                  plan.nodes.size() == 1 ? "1 node" : fmt::format("{} nodes", plan.nodes.size()),
                  text(plan.duration), plan.seed);
  out += fmt::format("  radio    {} at {} (group frames at {}), {}, {}\n", plan.radio.standard(),
                     scenario::format_quantity(plan.radio.data_rate_kbps(), scenario::kBitRate),
                     scenario::format_quantity(plan.radio.group_rate_kbps(), scenario::kBitRate),
                     scenario::format_quantity(plan.radio.carrier_hz(), scenario::kFrequency),
                     radio_terms(plan.radio));
  out += fmt::format("  network  {}, attach {}, {}\n", subnet_text(plan.subnet),
                     name_of(scenario::kAttachNames, plan.attach),
                     plan.static_neighbours ? "static neighbours" : "ARP");
  if (plan.page_port) {
    out += fmt::format("  page     http://127.0.0.1:{}/\n", *plan.page_port);
  }
  append_nodes(plan, out);
  const CapacityEstimate& capacity = plan.capacity;
  out += fmt::format(
      "  estimate {:.0f} frames/s, {:.0f} copies/s, air busy {:.0f} %; cores: emulator {:.2f}, "
      "world {:.2f}, agents {:.2f}\n",
      capacity.frames_per_s, capacity.copies_per_s, 100.0 * capacity.air_busy_fraction,
      capacity.emulator_cores, capacity.world_cores, capacity.agent_cores);
  for (const std::string& warning : capacity.warnings) {
    out += "  warning  " + warning + '\n';
  }
  return out;
}

}  // namespace cuscus::orchestrator
