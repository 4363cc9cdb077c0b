#include "world/app/fleet_collisions.h"

#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace cuscus::world {
namespace {

std::string place_text(const Eigen::Vector3d& p_m) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.2f, %.2f, %.2f) m", p_m.x(), p_m.y(), p_m.z());
  return text.data();
}

std::vector<CollisionBody> bodies_of(const std::vector<FleetCollisions::Member>& members) {
  std::vector<CollisionBody> bodies;
  bodies.reserve(members.size());
  for (const FleetCollisions::Member& member : members) {
    bodies.push_back(member.body);
  }
  return bodies;
}

}  // namespace

FleetCollisions::FleetCollisions(std::vector<Member> members, const Surroundings& surroundings,
                                 std::span<const std::string> buildings)
    : members_{std::move(members)},
      has_city_{surroundings.has_city()},
      buildings_{buildings},
      tallies_(members_.size()),
      collisions_{bodies_of(members_), surroundings} {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const auto& [node, name, plant, index, body] = members_[i];
    states_.push_back(plant->state(index));
    rise_from_slope(i);
    check_start(i);
    const auto vehicle = static_cast<std::uint32_t>(i);
    collisions_.place(vehicle, states_[i].p_WB_m);
    if (collisions_.stands(vehicle, states_[i].p_WB_m)) {
      plant->rest(index);
      states_[i] = plant->state(index);
    }
  }
}

void FleetCollisions::rise_from_slope(std::size_t member) {
  // One time on a plane; where the ground bends, each leaves a small part of the gap.
  constexpr int kMostTimes = 20;
  const auto& [node, name, plant, index, body] = members_[member];
  RigidBodyState& state = states_[member];
  for (int i = 0; i < kMostTimes; ++i) {
    const auto surface = collisions_.in_the_way(static_cast<std::uint32_t>(member), state.p_WB_m);
    if (!surface || surface->body != city::Body::kGround) {
      return;
    }
    state.p_WB_m.z() += (body.radius_m - surface->distance_m) / surface->normal.z();
    plant->set_state(index, state);
  }
}

void FleetCollisions::check_start(std::size_t member) const {
  if (!has_city_) {
    return;
  }
  const Eigen::Vector3d& p_WB_m = states_[member].p_WB_m;
  const auto surface = collisions_.in_the_way(static_cast<std::uint32_t>(member), p_WB_m);
  if (surface) {
    const double radius_m = members_[member].body.radius_m;
    throw std::invalid_argument{members_[member].name + " starts at " + place_text(p_WB_m) +
                                ", which is not free: " + name_of(surface->body, surface->index) +
                                " is there; allowed: on or above the ground, and " +
                                std::to_string(radius_m) + " m from all else"};
  }
}

void FleetCollisions::step(SimTime now) {
  first_contacts_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    states_[i] = members_[i].plant->state(members_[i].index);
  }
  collisions_.step(states_, now);
  for (const auto& [vehicle, rests] : collisions_.moved()) {
    const Member& member = members_[vehicle];
    member.plant->set_state(member.index, states_[vehicle]);
    if (rests) {
      member.plant->rest(member.index);
      states_[vehicle] = member.plant->state(member.index);
    }
  }
  for (const CollisionEvent& event : collisions_.events()) {
    count(event);
  }
}

void FleetCollisions::count(const CollisionEvent& event) {
  const Member& member = members_[event.vehicle];
  Tally& tally = tallies_[event.vehicle];
  if (tally.contacts() == 0) {
    first_contacts_.push_back({.name = member.name,
                               .what = name_of(event.struck),
                               .p_WB_m = event.p_WB_m,
                               .speed_mps = event.speed_mps,
                               .crash = event.crash});
  }
  switch (event.struck.kind) {
    case Struck::Kind::kBuilding:
      ++tally.buildings;
      break;
    case Struck::Kind::kGround:
      ++tally.ground;
      break;
    case Struck::Kind::kTree:
    case Struck::Kind::kWood:
      ++tally.trees;
      break;
    case Struck::Kind::kVehicle:
      ++tally.vehicles;
      break;
  }
  if (event.crash) {
    tally.crashed = true;
    member.plant->set_commands(member.index, RotorCommands{});
  }
}

std::string FleetCollisions::name_of(const Struck& struck) const {
  switch (struck.kind) {
    case Struck::Kind::kBuilding:
      return name_of(city::Body::kBuilding, struck.index);
    case Struck::Kind::kTree:
      return name_of(city::Body::kTree, struck.index);
    case Struck::Kind::kWood:
      return name_of(city::Body::kWood, struck.index);
    case Struck::Kind::kVehicle:
      return members_[struck.index].name;
    case Struck::Kind::kGround:
      break;
  }
  return name_of(city::Body::kGround, 0);
}

std::string FleetCollisions::name_of(city::Body body, std::uint32_t index) const {
  switch (body) {
    case city::Body::kBuilding:
      return index < buildings_.size() ? buildings_[index] : "building " + std::to_string(index);
    case city::Body::kTree:
      return "tree " + std::to_string(index);
    case city::Body::kWood:
      return "wood " + std::to_string(index);
    case city::Body::kGround:
      break;
  }
  return "the ground";
}

void FleetCollisions::report(proto::WorldReport& report) const {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Tally& tally = tallies_[i];
    if (tally.contacts() == 0) {
      continue;
    }
    proto::CollisionTally& entry = *report.add_collisions();
    entry.set_node(members_[i].node);
    entry.set_buildings(tally.buildings);
    entry.set_ground(tally.ground);
    entry.set_trees(tally.trees);
    entry.set_vehicles(tally.vehicles);
    entry.set_crashed(tally.crashed);
  }
}

}  // namespace cuscus::world
