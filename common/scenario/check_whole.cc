#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/scenario/names.h"
#include "common/scenario/placeholders.h"
#include "common/scenario/section_readers.h"
#include "common/units/autopilot_limits.h"

namespace cuscus::scenario {
namespace {

std::string text_of(Duration time) {
  return format_quantity(static_cast<double>(time.count()), kTime);
}

std::string quoted(Duration time) { return '"' + text_of(time) + '"'; }

std::string group_path(std::size_t group) { return "/fleet/" + std::to_string(group); }

std::set<std::string> node_names(const Scenario& scenario) {
  std::set<std::string> names;
  for (const Group& group : scenario.fleet) {
    for (std::uint32_t member = 0; member < group.count; ++member) {
      names.insert(uav_name(group, member));
    }
  }
  if (scenario.ground_station.enabled) {
    names.emplace(kGroundStationName);
  }
  return names;
}

void check_counts(const Scenario& scenario, Problems& problems) {
  const std::uint32_t uavs = scenario.uav_count();
  if (uavs > kMaxUavs) {
    problems.add("/fleet", "has " + std::to_string(uavs) + " UAVs; allowed: 1 ... " +
                               std::to_string(kMaxUavs));
  }
  const std::uint32_t nodes = scenario.node_count();
  if (uavs <= kMaxUavs && nodes > kMaxNodes) {
    problems.add("/fleet",
                 "has " + std::to_string(uavs) + " UAVs, which are " + std::to_string(nodes) +
                     " nodes with the ground station; allowed: 1 ... " + std::to_string(kMaxNodes));
  }
  const std::uint32_t hosts = scenario.network.subnet.host_count();
  if (nodes > hosts) {
    problems.add("/network/subnet", "\"" + subnet_text(scenario.network.subnet) + "\" has " +
                                        std::to_string(hosts) + " addresses for " +
                                        std::to_string(nodes) +
                                        " nodes; allowed: a larger network, such as "
                                        "\"10.42.0.0/16\"");
  }
}

void check_names(const Scenario& scenario, Problems& problems) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    if (!names.insert(scenario.fleet[i].name).second) {
      problems.add(group_path(i) + "/name", "\"" + scenario.fleet[i].name +
                                                "\" is the name of a group before; allowed: each "
                                                "name once");
    }
  }
}

void check_ports(const Scenario& scenario, Problems& problems) {
  std::map<std::uint16_t, std::string> owners;
  if (scenario.ground_station.enabled) {
    owners[scenario.ground_station.telemetry_port] = "/ground_station/telemetry_port";
  }
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    const std::string path = group_path(i) + "/neighbours/port";
    const auto [owner, is_new] = owners.emplace(group.neighbours.port, path);
    if (!is_new) {
      problems.add(path, std::to_string(group.neighbours.port) + " is taken by " + owner->second +
                             "; allowed: a port of its own, 1024 ... 65535");
    }
  }
}

void check_lift(const Scenario& scenario, Problems& problems) {
  const double most_thrust_N = 4.0 * kX4ThrustFactor_N * kX4SpeedPerCommand * kX4SpeedPerCommand;
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const auto* x4 = std::get_if<X4Vehicle>(&scenario.fleet[i].vehicle);
    const double most_mass_kg = most_thrust_N / scenario.world.gravity_mps2;
    if (x4 != nullptr && x4->mass_kg >= most_mass_kg) {
      problems.add(group_path(i) + "/vehicle/mass",
                   "\"" + format_quantity(x4->mass_kg, kMass) +
                       "\" is more than an x4 lifts; allowed: less than " +
                       format_quantity(std::floor(most_mass_kg * 1000.0) / 1000.0, kMass));
    }
  }
}

bool is_flown_by_ours(const Group& group) { return group.autopilot && group.agent.empty(); }

/// What our autopilot needs: newer commands than the motors wait for, and sensors that it hears.
void check_control(const Scenario& scenario, Problems& problems) {
  bool piloted = false;
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    const auto* x4 = std::get_if<X4Vehicle>(&group.vehicle);
    if (x4 == nullptr || !is_flown_by_ours(group)) {
      continue;
    }
    piloted = true;
    if (group.control_period >= x4->motor_timeout) {
      problems.add(group_path(i) + "/control_period",
                   quoted(group.control_period) + " lets the motors stop between two commands; " +
                       "allowed: less than motor_timeout, here " + text_of(x4->motor_timeout));
    }
  }
  const auto check_rate = [&](const std::string& path, Duration period, Duration timeout) {
    if (piloted && period >= timeout) {
      problems.add(path, "has a period of " + text_of(period) +
                             ", and the autopilot takes the sensor for lost after " +
                             text_of(timeout) + "; allowed: more than " +
                             format_quantity(1.0 / to_seconds(timeout), kFrequency));
    }
  };
  check_rate("/world/imu/rate", scenario.world.imu_period, kImuTimeout);
  check_rate("/world/motion_capture/rate", scenario.world.motion_capture_period,
             kMotionCaptureTimeout);
}

/// Speed at which turning and drag together take all the tilt that the autopilot gives: at speed v
/// on radius R with drag k of mass m it needs the acceleration sqrt((v^2 / R)^2 + (k v / m)^2).
double fastest_mps(const CircleMission& circle, const X4Vehicle& x4, double gravity_mps2) {
  const double limit_mps2 = gravity_mps2 * std::tan(kTiltReferenceLimit_rad);
  const double drag_ps = x4.drag_lateral_Nspm / x4.mass_kg;
  const double turn_mps2 = 2.0 * limit_mps2 / circle.radius_m;
  const double drag2_ps2 = drag_ps * drag_ps;
  return limit_mps2 * std::sqrt(2.0 / (drag2_ps2 + std::hypot(drag2_ps2, turn_mps2)));
}

void check_speed(const Scenario& scenario, Problems& problems) {
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    const auto* x4 = std::get_if<X4Vehicle>(&group.vehicle);
    if (x4 == nullptr || !group.mission || !is_flown_by_ours(group)) {
      continue;
    }
    const double most_mps = fastest_mps(*group.mission, *x4, scenario.world.gravity_mps2);
    if (group.mission->speed_mps > most_mps) {
      problems.add(group_path(i) + "/mission/speed",
                   '"' + format_quantity(group.mission->speed_mps, kSpeed) +
                       "\" takes more than the 15 deg of tilt that the autopilot gives, on this " +
                       "radius and with this drag; allowed: up to " +
                       format_quantity(std::floor(most_mps * 100.0) / 100.0, kSpeed));
    }
  }
}

void check_positions(const Scenario& scenario, Problems& problems) {
  constexpr double kCell_m = 0.01;
  std::map<std::array<long long, 3>, std::string> taken;
  const auto place = [&](const Position_m& p_m, const std::string& name, const std::string& path) {
    if (p_m[2] < 0.0) {
      problems.add(path, name + " is below the ground, at z = " + format_quantity(p_m[2], kLength) +
                             "; allowed: z from 0 m");
    }
    const auto [owner, is_new] =
        taken.emplace(std::array{std::llround(p_m[0] / kCell_m), std::llround(p_m[1] / kCell_m),
                                 std::llround(p_m[2] / kCell_m)},
                      name);
    if (!is_new) {
      problems.add(path,
                   name + " is where " + owner->second + " is; allowed: positions that are apart");
    }
  };
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    const auto positions = start_positions(group);
    for (std::uint32_t member = 0; member < group.count; ++member) {
      place(positions[member], uav_name(group, member), group_path(i) + "/start");
    }
  }
  if (scenario.ground_station.enabled) {
    place(scenario.ground_station.position_m, std::string{kGroundStationName},
          "/ground_station/position");
  }
}

/// The autopilot takes where it stands for the ground.
/// On roofs only the world knows what a vehicle stands on.
void check_standing(const Scenario& scenario, Problems& problems) {
  if (scenario.city) {
    return;
  }
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    const auto positions = start_positions(group);
    const auto above = std::find_if(positions.begin(), positions.end(),
                                    [](const Position_m& p_m) { return p_m[2] > 0.0; });
    if (!group.is_fixed() && above != positions.end()) {
      const auto member = static_cast<std::uint32_t>(above - positions.begin());
      problems.add(group_path(i) + "/start",
                   uav_name(group, member) +
                       " is above the ground, at z = " + format_quantity((*above)[2], kLength) +
                       ", from where it would fall; allowed: z = 0 m, or the vehicle fixed");
    }
  }
}

/// Longest frame at `rate_kbps`, and the guard time behind it, against the slot.
void check_slot(const Scenario& scenario, const TdmaMac& tdma, std::uint32_t rate_kbps,
                const std::string& key, Problems& problems) {
  const double airtime_us = 1e6 * airtime_s(scenario.radio, scenario.network.mtu_bytes, rate_kbps);
  const Duration needed =
      std::chrono::microseconds{std::llround(std::ceil(airtime_us - 1e-6))} + tdma.guard;
  if (needed > tdma.slot) {
    problems.add("/radio/mac/slot", quoted(tdma.slot) + " is too short for an IP packet of " +
                                        std::to_string(scenario.network.mtu_bytes) +
                                        " B (network/mtu) at the " + key + " of " +
                                        format_quantity(rate_kbps, kBitRate) +
                                        " and the guard time; allowed: from " + text_of(needed));
  }
}

/// A MAC without ACKs has nothing to learn from, and nothing to announce.
void check_acknowledgement(const Scenario& scenario, Problems& problems) {
  if (acknowledges(scenario.radio.mac)) {
    return;
  }
  const std::string mac = std::holds_alternative<TdmaMac>(scenario.radio.mac) ? "tdma" : "ideal";
  if (scenario.radio.rate_control != RateControl::kConstant) {
    problems.add("/radio/rate_control",
                 '"' + name_of(kRateControlNames, scenario.radio.rate_control) +
                     "\" learns from ACKs, and " + mac + " has none; allowed: constant");
  }
  if (scenario.radio.rts_threshold_bytes) {
    problems.add("/radio/rts_threshold", std::to_string(*scenario.radio.rts_threshold_bytes) +
                                             " announces frames, and " + mac +
                                             " does not; allowed: none");
  }
}

void check_tdma(const Scenario& scenario, Problems& problems) {
  const auto* tdma = std::get_if<TdmaMac>(&scenario.radio.mac);
  if (tdma == nullptr) {
    return;
  }
  check_slot(scenario, *tdma, scenario.radio.data_rate_kbps, "data_rate", problems);
  if (scenario.radio.group_rate_kbps != scenario.radio.data_rate_kbps) {
    check_slot(scenario, *tdma, scenario.radio.group_rate_kbps, "group_rate", problems);
  }
  const std::set<std::string> names = node_names(scenario);
  for (std::size_t slot = 0; slot < tdma->frame.size(); ++slot) {
    if (tdma->frame[slot] != kNoOwner && !names.contains(tdma->frame[slot])) {
      const std::string near = nearest(tdma->frame[slot], {names.begin(), names.end()});
      problems.add("/radio/mac/frame/" + std::to_string(slot),
                   '"' + tdma->frame[slot] + "\" is no node; " +
                       (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                       "allowed: names of nodes, such as \"" + *names.begin() + "\", or \"-\"");
    }
  }
}

void check_captures(const Scenario& scenario, Problems& problems) {
  const std::set<std::string> names = node_names(scenario);
  const std::vector<std::string>& captured = scenario.record.captures.nodes;
  for (std::size_t i = 0; i < captured.size(); ++i) {
    if (!names.contains(captured[i])) {
      const std::string near = nearest(captured[i], {names.begin(), names.end()});
      problems.add("/record/captures/" + std::to_string(i),
                   '"' + captured[i] + "\" is no node; " +
                       (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                       "allowed: names of nodes, such as \"" + *names.begin() + '"');
    }
  }
}

void check_obstacles(const Scenario& scenario, Problems& problems) {
  const Radio& radio = scenario.radio;
  if (!radio.obstacles.empty() && draws_line_of_sight(radio.propagation)) {
    problems.add("/radio/obstacles",
                 "are a map, and the model of radio/propagation stands in for one by chance of "
                 "line of sight; allowed: friis, log-distance, paper-eq1, two-ray, p1411, or no "
                 "obstacles");
  }
  if (scenario.city && draws_line_of_sight(radio.propagation)) {
    problems.add("/city",
                 "is a map, and the model of radio/propagation stands in for one by chance of line "
                 "of sight; allowed: friis, log-distance, paper-eq1, two-ray, p1411, or no city");
  }
}

void check_site(const Scenario& scenario, Problems& problems) {
  if (scenario.city && scenario.world.site) {
    problems.add("/world/site",
                 "is told by the city, which has coordinates of its own; allowed: no site beside a "
                 "city");
  }
}

/// Fills the placeholders in as the plan will, with addresses that only need to exist.
void check_placeholders(const Scenario& scenario, Problems& problems) {
  const std::set<std::string> names = node_names(scenario);
  PlaceholderValues values;
  values.index = values.count = values.name = values.group = values.ip = "0";
  values.broadcast = values.scenario_dir = "0";
  if (scenario.ground_station.enabled) {
    values.gcs_ip = "0";
  }
  values.ip_of = [&names](const std::string& name) {
    return names.contains(name) ? std::optional<std::string>{"0"} : std::nullopt;
  };
  const auto check = [&](const std::string& text, const std::string& path) {
    try {
      static_cast<void>(expand(text, values));
    } catch (const PlaceholderError& error) {
      problems.add(path, error.what());
    }
  };
  for (std::size_t i = 0; i < scenario.fleet.size(); ++i) {
    const Group& group = scenario.fleet[i];
    for (const auto& [key, program] :
         {std::pair{"agent", &group.agent}, {"command", &group.command}}) {
      for (std::size_t argument = 0; argument < program->size(); ++argument) {
        check((*program)[argument], group_path(i) + '/' + key + '/' + std::to_string(argument));
      }
    }
    for (const auto& [name, text] : group.environment) {
      check(text, group_path(i) + "/environment/" + name);
    }
  }
}

}  // namespace

void check_whole(const Scenario& scenario, Problems& problems) {
  check_counts(scenario, problems);
  check_names(scenario, problems);
  check_ports(scenario, problems);
  check_lift(scenario, problems);
  check_control(scenario, problems);
  check_speed(scenario, problems);
  check_positions(scenario, problems);
  check_standing(scenario, problems);
  check_placeholders(scenario, problems);
  check_acknowledgement(scenario, problems);
  check_tdma(scenario, problems);
  check_captures(scenario, problems);
  check_obstacles(scenario, problems);
  check_site(scenario, problems);
}

}  // namespace cuscus::scenario
