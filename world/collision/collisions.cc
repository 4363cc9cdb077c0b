#include "world/collision/collisions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

namespace cuscus::world {
namespace {

/// How far to look for the nearest surface: further takes longer and is asked less often.
constexpr double kLook_m = 10.0;
/// Ways are summed up rounded; a distance is used up this much earlier.
constexpr double kRounding_m = 1e-6;
/// What has not been touched for so long is hit anew.
constexpr SimClock::duration kMemory = std::chrono::milliseconds{100};

std::vector<double> radii_of(const std::vector<CollisionBody>& bodies) {
  std::vector<double> radii_m;
  radii_m.reserve(bodies.size());
  for (const CollisionBody& body : bodies) {
    radii_m.push_back(body.radius_m);
  }
  return radii_m;
}

Struck struck_of(const city::Contact& contact) {
  switch (contact.body) {
    case city::Body::kBuilding:
      return {.kind = Struck::Kind::kBuilding, .index = contact.index};
    case city::Body::kTree:
      return {.kind = Struck::Kind::kTree, .index = contact.index};
    case city::Body::kWood:
      return {.kind = Struck::Kind::kWood, .index = contact.index};
    case city::Body::kGround:
      break;
  }
  return {.kind = Struck::Kind::kGround, .index = contact.index};
}

bool is_upright(const RigidBodyState& state) {
  return (state.q_WB * Eigen::Vector3d::UnitZ()).z() > kStandingCosine;
}

bool is_landing(const Impact& impact, const RigidBodyState& state) {
  return carries(impact.contact.normal) && impact.speed_mps <= kLandingSpeed_mps &&
         is_upright(state);
}

}  // namespace

Collisions::Collisions(std::vector<CollisionBody> bodies, Surroundings surroundings)
    : bodies_{std::move(bodies)},
      surroundings_{surroundings},
      close_pairs_{radii_of(bodies_)},
      centres_(bodies_.size(), Eigen::Vector3d::Zero()),
      way_m_(bodies_.size(), 0.0),
      free_m_(bodies_.size(), 0.0),
      recent_(bodies_.size()),
      crashed_(bodies_.size(), false),
      is_moved_(bodies_.size(), 0) {
  moved_.reserve(bodies_.size());
  events_.reserve(bodies_.size());
  meetings_.reserve(bodies_.size());
}

Eigen::Vector3d Collisions::centre(std::size_t vehicle, const Eigen::Vector3d& p_WB_m) const {
  return {p_WB_m.x(), p_WB_m.y(), p_WB_m.z() + bodies_[vehicle].radius_m};
}

MovingBall Collisions::ball(std::size_t vehicle, const RigidBodyState& state) const {
  return {.p_WC = centres_[vehicle],
          .target = centre(vehicle, state.p_WB_m),
          .v_mps = state.v_WB_W_mps};
}

void Collisions::place(std::uint32_t vehicle, const Eigen::Vector3d& p_WB_m) {
  close_pairs_.went_further((centre(vehicle, p_WB_m) - centres_[vehicle]).norm());
  centres_[vehicle] = centre(vehicle, p_WB_m);
  free_m_[vehicle] = 0.0;
}

std::optional<city::Surface> Collisions::in_the_way(std::uint32_t vehicle,
                                                    const Eigen::Vector3d& p_WB_m) const {
  const double radius_m = bodies_[vehicle].radius_m;
  const auto surface = surroundings_.nearest(centre(vehicle, p_WB_m), radius_m);
  return surface && surface->distance_m < radius_m - kRounding_m ? surface : std::nullopt;
}

bool Collisions::stands(std::uint32_t vehicle, const Eigen::Vector3d& p_WB_m) const {
  const auto surface =
      surroundings_.nearest(centre(vehicle, p_WB_m), bodies_[vehicle].radius_m + kRounding_m);
  return surface && carries(surface->normal);
}

void Collisions::step(std::span<RigidBodyState> states, SimTime now) {
  for (const Moved& moved : moved_) {
    is_moved_[moved.vehicle] = 0;
  }
  moved_.clear();
  events_.clear();
  pass_one_another(states, measure_ways(states), now);
  for (std::size_t i = 0; i < states.size(); ++i) {
    free_m_[i] -= way_m_[i];
    if (free_m_[i] <= 0.0 && !is_free(i)) {
      pass_surroundings(i, states[i], now);
    }
    centres_[i] = centre(i, states[i].p_WB_m);
  }
}

double Collisions::measure_ways(std::span<const RigidBodyState> states) {
  double most_m = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    way_m_[i] = (centre(i, states[i].p_WB_m) - centres_[i]).norm();
    most_m = std::max(most_m, way_m_[i]);
  }
  return most_m;
}

void Collisions::pass_one_another(std::span<RigidBodyState> states, double most_way_m,
                                  SimTime now) {
  meetings_.clear();
  for (const BallPair& pair : close_pairs_.during(centres_, most_way_m)) {
    const double reach_m = bodies_[pair.a].radius_m + bodies_[pair.b].radius_m;
    const auto t = meeting(ball(pair.a, states[pair.a]), ball(pair.b, states[pair.b]), reach_m);
    if (t) {
      meetings_.push_back({.t = *t, .pair = pair});
    }
  }
  std::sort(meetings_.begin(), meetings_.end(), [](const Meeting& one, const Meeting& other) {
    return std::tie(one.t, one.pair.a, one.pair.b) < std::tie(other.t, other.pair.a, other.pair.b);
  });
  for (const Meeting& found : meetings_) {
    meet(found.pair, states, now);
  }
}

void Collisions::meet(const BallPair& pair, std::span<RigidBodyState> states, SimTime now) {
  MovingBall a = ball(pair.a, states[pair.a]);
  MovingBall b = ball(pair.b, states[pair.b]);
  // Anew: an earlier meeting of this step may have turned one of them away.
  const auto t = meeting(a, b, bodies_[pair.a].radius_m + bodies_[pair.b].radius_m);
  if (!t) {
    return;
  }
  const double speed_mps = part(a, bodies_[pair.a], b, bodies_[pair.b], *t);
  note(pair.a, {.kind = Struck::Kind::kVehicle, .index = pair.b}, states[pair.a], speed_mps, now);
  note(pair.b, {.kind = Struck::Kind::kVehicle, .index = pair.a}, states[pair.b], speed_mps, now);
  divert(pair.a, states[pair.a], a.target, a.v_mps, false);
  divert(pair.b, states[pair.b], b.target, b.v_mps, false);
}

bool Collisions::is_free(std::size_t vehicle) {
  if (way_m_[vehicle] == 0.0) {
    return true;  // it stands
  }
  const double radius_m = bodies_[vehicle].radius_m;
  const auto surface = surroundings_.nearest(centres_[vehicle], radius_m + kLook_m);
  const double distance_m = surface ? surface->distance_m : radius_m + kLook_m;
  free_m_[vehicle] = distance_m - radius_m - kRounding_m - way_m_[vehicle];
  return free_m_[vehicle] > 0.0;
}

void Collisions::pass_surroundings(std::size_t vehicle, RigidBodyState& state, SimTime now) {
  const Passage way = passage(surroundings_, bodies_[vehicle], centres_[vehicle],
                              centre(vehicle, state.p_WB_m), state.v_WB_W_mps);
  if (way.impact_count == 0) {
    return;
  }
  for (std::size_t i = 0; i < way.impact_count; ++i) {
    const Impact& impact = way.impacts[i];
    if (!is_landing(impact, state)) {
      note(vehicle, struck_of(impact.contact), state, impact.speed_mps, now);
    }
  }
  divert(vehicle, state, way.p_WC, way.v_WC_mps, way.rests);
}

void Collisions::divert(std::size_t vehicle, RigidBodyState& state, const Eigen::Vector3d& p_WC,
                        const Eigen::Vector3d& v_mps, bool rests) {
  close_pairs_.went_further((p_WC - centre(vehicle, state.p_WB_m)).norm());
  state.p_WB_m = p_WC - Eigen::Vector3d{0.0, 0.0, bodies_[vehicle].radius_m};
  state.v_WB_W_mps = v_mps;
  way_m_[vehicle] = (p_WC - centres_[vehicle]).norm();
  const auto index = static_cast<std::uint32_t>(vehicle);
  if (is_moved_[vehicle] == 0) {
    is_moved_[vehicle] = 1;
    moved_.push_back({.vehicle = index, .rests = rests});
  } else if (rests) {
    const auto known = std::find_if(moved_.begin(), moved_.end(),
                                    [index](const Moved& moved) { return moved.vehicle == index; });
    known->rests = true;
  }
}

void Collisions::note(std::size_t vehicle, const Struck& struck, const RigidBodyState& state,
                      double speed_mps, SimTime now) {
  if (!begins(vehicle, struck, now) || crashed_[vehicle]) {
    return;
  }
  crashed_[vehicle] = bodies_[vehicle].behaviour == CollisionBehaviour::kCrash;
  events_.push_back({.vehicle = static_cast<std::uint32_t>(vehicle),
                     .struck = struck,
                     .p_WB_m = state.p_WB_m,
                     .speed_mps = speed_mps,
                     .crash = crashed_[vehicle]});
}

bool Collisions::begins(std::size_t vehicle, const Struck& struck, SimTime now) {
  std::array<Recent, 4>& recent = recent_[vehicle];
  Recent* oldest = recent.data();
  for (Recent& one : recent) {
    if (one.struck == struck && one.until > now) {
      one.until = now + kMemory;
      return false;
    }
    if (one.until < oldest->until) {
      oldest = &one;
    }
  }
  *oldest = {.struck = struck, .until = now + kMemory};
  return true;
}

}  // namespace cuscus::world
