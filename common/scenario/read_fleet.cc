#include <algorithm>
#include <array>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxGroups = 100;
constexpr std::size_t kMaxArguments = 256;
constexpr std::size_t kMaxArgumentBytes = 4096;
constexpr std::uint16_t kFirstBeaconPort = 47100;
constexpr std::string_view kNameRule =
    "1 ... 11 of a-z, 0-9 and '-', first and last a letter; \"gcs\" is the ground station";

/// What a program may be given; capabilities that reach beyond its own namespaces are not here.
constexpr std::array kCapabilities{"cap_net_raw",       "cap_net_admin", "cap_net_bind_service",
                                   "cap_net_broadcast", "cap_sys_nice",  "cap_ipc_lock"};

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_group_name(const std::string& name) {
  constexpr std::size_t kLongest = 11;  // uav1000 and "tap-" still fit an interface's 15 characters
  return !name.empty() && name.size() <= kLongest && is_lower(name.front()) &&
         is_lower(name.back()) && std::all_of(name.begin(), name.end(), [](char c) {
           return is_lower(c) || is_digit(c) || c == '-';
         });
}

ListLayout read_list_layout(ObjectReader& reader, std::uint32_t count) {
  ListLayout list;
  const json* positions = reader.child("positions");
  if (positions == nullptr || !positions->is_array() || positions->size() != count) {
    const std::string given = positions == nullptr ? "is missing"
                              : positions->is_array()
                                  ? "has " + std::to_string(positions->size()) + " elements"
                                  : shown(*positions) + " is not an array";
    reader.problem("positions", given + "; allowed: " + std::to_string(count) +
                                    " positions, one per UAV of the group");
    list.positions_m.resize(count);
    return list;
  }
  // An object whose keys are the indices lets the reader of one position say where it is.
  for (std::size_t i = 0; i < positions->size(); ++i) {
    const json one{{std::to_string(i), positions->at(i)}};
    ObjectReader element{&one, reader.path_of("positions"), reader.problems()};
    list.positions_m.push_back(element.lengths<3>(std::to_string(i), {}));
  }
  return list;
}

Start read_start(const json* value, const std::string& path, std::uint32_t count,
                 const std::optional<CircleMission>& mission, Problems& problems) {
  Start start;
  ObjectReader reader{value, path, problems};
  const QuantityRange spacing_range{kLength, "10 cm", "10 km"};
  const QuantityRange angle_range{kAngle, "-360 deg", "360 deg"};
  start.heading_rad = reader.quantity("heading", start.heading_rad, angle_range);
  const Position_m centre =
      mission ? Position_m{mission->centre_m[0], mission->centre_m[1], 0.0} : Position_m{};
  switch (reader.choice_index("layout", {"grid", "circle", "line", "list"})) {
    case 1: {
      CircleLayout circle;
      circle.radius_m = reader.quantity("radius", mission ? mission->radius_m : circle.radius_m,
                                        {kLength, "10 cm", "10 km"});
      circle.centre_m = reader.lengths("centre", centre);
      start.layout = circle;
      break;
    }
    case 2: {
      LineLayout line;
      line.spacing_m = reader.quantity("spacing", line.spacing_m, spacing_range);
      line.centre_m = reader.lengths("centre", centre);
      line.direction_rad = reader.quantity("direction", line.direction_rad, angle_range);
      start.layout = line;
      break;
    }
    case 3:
      start.layout = read_list_layout(reader, count);
      break;
    default: {
      if (value != nullptr && value->is_object() && !reader.has("layout")) {
        reader.missing("layout", "grid, circle, line, list");
        return start;
      }
      GridLayout grid;
      grid.spacing_m = reader.quantity("spacing", grid.spacing_m, spacing_range);
      grid.centre_m = reader.lengths("centre", centre);
      start.layout = grid;
    }
  }
  reader.finish();
  return start;
}

std::optional<CircleMission> read_mission(const json* value, const std::string& path,
                                          Problems& problems) {
  if (value == nullptr || *value == "none") {
    return std::nullopt;
  }
  if (value->is_string()) {
    problems.add(path, shown(*value) + " is not known; allowed: none, or an object with a type");
    return std::nullopt;
  }
  CircleMission mission;
  ObjectReader reader{value, path, problems};
  if (reader.choice_index("type", {"circle"}) == 1 && !reader.has("type") && value->is_object()) {
    reader.missing("type", "circle");
  }
  mission.centre_m = reader.lengths("centre", mission.centre_m);
  mission.radius_m = reader.quantity("radius", mission.radius_m, {kLength, "50 cm", "10 km"});
  mission.altitude_m = reader.quantity("altitude", mission.altitude_m, {kLength, "50 cm", "1 km"});
  mission.speed_mps = reader.quantity("speed", mission.speed_mps, {kSpeed, "0 m/s", "30 m/s"});
  mission.spacing_gain = reader.number("spacing_gain", mission.spacing_gain, {0.0, 10.0});
  reader.finish();
  return mission;
}

Neighbours read_neighbours(const json* value, const std::string& path, std::size_t group_index,
                           Problems& problems) {
  Neighbours neighbours;
  ObjectReader reader{value, path, problems};
  neighbours.source = reader.choice("source", neighbours.source, kNeighbourSourceNames);
  neighbours.beacon_period =
      reader.duration("beacon_period", neighbours.beacon_period, "1 ms", "10 s");
  const Duration default_timeout = std::max(neighbours.timeout, 3 * neighbours.beacon_period);
  neighbours.timeout = reader.duration("timeout", default_timeout, "1 ms", "60 s");
  if (neighbours.timeout < neighbours.beacon_period) {
    reader.problem(
        "timeout",
        "is shorter than beacon_period; allowed: " +
            format_quantity(static_cast<double>(neighbours.beacon_period.count()), kTime) +
            " ... 60 s");
  }
  neighbours.port = reader.integer<std::uint16_t>(
      "port", static_cast<std::uint16_t>(kFirstBeaconPort + group_index), {1024, 65535});
  reader.finish();
  return neighbours;
}

/// The executable as the run will start it: absolute, or a name to be searched in PATH.
std::string resolved_executable(const std::string& executable, const std::string& path,
                                const std::filesystem::path& folder, Problems& problems) {
  if (executable.empty()) {
    problems.add(path, "is empty; allowed: a program, such as \"ping\" or \"./my-program\"");
    return executable;
  }
  if (executable.find('/') == std::string::npos || executable.front() == '/') {
    return executable;
  }
  const std::filesystem::path relative = std::filesystem::path{executable}.lexically_normal();
  if (relative.begin()->string() == "..") {
    problems.add(path, shown(executable) +
                           " leaves the scenario's folder; allowed: a path below "
                           "it, an absolute path, or a name in PATH");
    return executable;
  }
  return (folder / relative).string();
}

/// A program and its arguments under `key`; nothing when the key is missing or says `standard`.
std::vector<std::string> read_program(ObjectReader& reader, const std::string& key,
                                      const std::string& standard,
                                      const std::filesystem::path& folder) {
  const json* value = reader.child(key);
  if (value == nullptr || *value == standard) {
    return {};
  }
  if (value->is_string()) {
    reader.problem(key, shown(*value) + " is one text; allowed: " + standard +
                            ", or an array of the program and its arguments, such as "
                            "[\"ping\", \"{gcs_ip}\"]");
    return {};
  }
  auto program = reader.texts(key, kMaxArguments, kMaxArgumentBytes);
  if (!program.empty()) {
    program.front() =
        resolved_executable(program.front(), reader.path_of(key) + "/0", folder, reader.problems());
  } else if (value->is_array() && value->empty()) {
    reader.problem(key, "is empty; allowed: " + standard + ", or at least the program");
  }
  return program;
}

void read_capabilities(ObjectReader& reader, Group& group) {
  group.capabilities = reader.texts("capabilities", kCapabilities.size(), 64);
  const std::vector<std::string> allowed(kCapabilities.begin(), kCapabilities.end());
  for (std::size_t i = 0; i < group.capabilities.size(); ++i) {
    const std::string& name = group.capabilities[i];
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      const std::string near = nearest(name, allowed);
      reader.problems().add(reader.path_of("capabilities") + '/' + std::to_string(i),
                            shown(name) + " cannot be given; " +
                                (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                                "allowed: " + joined(allowed));
    }
  }
}

void read_environment(ObjectReader& reader, Group& group) {
  const json* value = reader.child("environment");
  ObjectReader variables{value, reader.path_of("environment"), reader.problems()};
  if (value == nullptr || !value->is_object()) {
    return;
  }
  for (const auto& [name, text] : value->items()) {
    const bool is_name = !name.empty() && !is_digit(name.front()) &&
                         std::all_of(name.begin(), name.end(), [](char c) {
                           return is_lower(c) || is_digit(c) || c == '_' || (c >= 'A' && c <= 'Z');
                         });
    if (!is_name || name.starts_with("CUSCUS_")) {
      variables.problem(name,
                        "is not a variable that can be set; allowed: letters, digits and _, "
                        "not a digit first, not CUSCUS_...");
    }
    group.environment[name] = variables.text(name, {}, kMaxArgumentBytes);
  }
}

Group read_group(const json& value, std::size_t index, const std::filesystem::path& folder,
                 Problems& problems) {
  const std::string path = "/fleet/" + std::to_string(index);
  Group group;
  ObjectReader reader{&value, path, problems};
  group.name = reader.text("name", "uav", 256);
  if (!is_group_name(group.name) || group.name == kGroundStationName) {
    reader.problem(
        "name", shown(group.name) + " is not a group's name; allowed: " + std::string{kNameRule});
  }
  group.count = reader.integer<std::uint32_t>("count", 1, {1, kMaxUavs});
  group.vehicle = read_vehicle(reader.child("vehicle"), reader.path_of("vehicle"), problems);
  group.mission = read_mission(reader.child("mission"), reader.path_of("mission"), problems);
  group.start = read_start(reader.child("start"), reader.path_of("start"), group.count,
                           group.mission, problems);
  group.autopilot = reader.boolean("autopilot", !group.is_fixed());
  if (group.is_fixed() && group.autopilot) {
    reader.problem("autopilot", "is true, but the vehicle is fixed; allowed: false");
  } else if (!group.autopilot && group.mission) {
    reader.problem("mission", "needs the autopilot, which this group has not; allowed: none");
  }
  group.neighbours =
      read_neighbours(reader.child("neighbours"), reader.path_of("neighbours"), index, problems);
  group.control_period = reader.duration("control_period", group.control_period, "1 ms", "1 s");
  group.telemetry_period =
      reader.duration("telemetry_period", group.telemetry_period, "10 ms", "60 s");
  group.agent = read_program(reader, "agent", "cuscus-agent", folder);
  if (!group.agent.empty() && !group.autopilot) {
    reader.problem("agent", "needs \"autopilot\": true; allowed: cuscus-agent");
  }
  group.command = read_program(reader, "command", "none", folder);
  read_capabilities(reader, group);
  read_environment(reader, group);
  group.on_exit = reader.choice("on_exit", group.on_exit, kOnExitNames);
  reader.finish();
  return group;
}

}  // namespace

std::vector<Group> read_fleet(const json* value, const std::filesystem::path& folder,
                              Problems& problems) {
  const std::string allowed = "an array of 1 ... " + std::to_string(kMaxGroups) + " groups of UAVs";
  std::vector<Group> fleet;
  if (value == nullptr) {
    problems.add("/fleet", "is missing; allowed: " + allowed);
    return fleet;
  }
  if (!value->is_array() || value->empty() || value->size() > kMaxGroups) {
    problems.add("/fleet", (value->is_array() ? "has " + std::to_string(value->size()) + " elements"
                                              : shown(*value) + " is not an array") +
                               "; allowed: " + allowed);
    return fleet;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    fleet.push_back(read_group(value->at(i), i, folder, problems));
  }
  return fleet;
}

}  // namespace cuscus::scenario
