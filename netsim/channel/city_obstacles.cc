#include "netsim/channel/city_obstacles.h"

#include <utility>

namespace cuscus::netsim {
namespace {

Turn turn_of(const city::Turn& turn) { return {.at_a = turn.at_a, .at_b = turn.at_b}; }

}  // namespace

CityObstacles::CityObstacles(const city::City& city,
                             std::shared_ptr<const city::CityGeometry> geometry,
                             const WallLosses& walls)
    : geometry_{std::move(geometry)},
      inner_wall_{walls.inner},
      has_foliage_{!city.trees.empty() || !city.woods.empty()} {
  outer_wall_.reserve(city.buildings.size());
  for (const city::Building& building : city.buildings) {
    outer_wall_.push_back(walls.outer[static_cast<std::size_t>(building.outer_walls)]);
  }
}

Obstruction CityObstacles::crossed(const city::Crossing& crossing, const Eigen::Vector3d& p_WA,
                                   const Eigen::Vector3d& p_WB) const {
  Obstruction result{.crossed = true};
  result.walls = {.outer = crossing.outer_walls, .inner = crossing.inner_walls};
  result.outer_loss = {crossing.outer_walls * outer_wall_[crossing.building].value};
  result.inner_loss = {crossing.mean_inner_walls * inner_wall_.value};
  if (!crossing.from_inside && !crossing.to_inside) {
    const city::Turns turns = geometry_->turns(crossing.building, p_WA, p_WB);
    result.turns[static_cast<std::size_t>(Way::kOver)] = turn_of(turns.over);
    result.turns[static_cast<std::size_t>(Way::kLeft)] = turn_of(turns.left);
    result.turns[static_cast<std::size_t>(Way::kRight)] = turn_of(turns.right);
  }
  return result;
}

void CityObstacles::look_at(std::span<const std::uint32_t> near, const Eigen::Vector3d& p_WA,
                            const Eigen::Vector3d& p_WB, double zone_m,
                            std::vector<Obstruction>& found) const {
  city::Crossings crossings;
  for (const std::uint32_t building : near) {
    if (geometry_->append_crossing(building, p_WA, p_WB, crossings)) {
      found.push_back(crossed(crossings.buildings.back(), p_WA, p_WB));
    } else if (const double clearance_m = geometry_->clearance_m(building, p_WA, p_WB);
               clearance_m < zone_m) {
      found.push_back({.clearance_m = clearance_m});
    }
  }
}

void CityObstacles::find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                         std::vector<Obstruction>& found) const {
  if (!((p_WB - p_WA).norm() > 0.0)) {
    return;
  }
  std::vector<std::uint32_t> near;
  geometry_->near(p_WA, p_WB, margin_m(p_WA, p_WB, zone_m, 0.0), near);
  look_at(near, p_WA, p_WB, zone_m, found);
}

double CityObstacles::foliage_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const {
  return has_foliage_ ? geometry_->foliage_m(p_WA, p_WB) : 0.0;
}

void CityObstacles::look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                                double zone_m, double slack_m, Nearby& nearby) const {
  const double reach_m = margin_m(p_WA, p_WB, zone_m, slack_m) + slack_m;
  geometry_->prisms_near(p_WA, p_WB, reach_m, nearby.bodies);
  if (has_foliage_) {
    geometry_->plants_near(p_WA, p_WB, slack_m, nearby.leaves);
  }
}

void CityObstacles::find(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                         const Eigen::Vector3d& p_WB, double zone_m,
                         std::vector<Obstruction>& found) const {
  if (nearby.bodies.empty() || !((p_WB - p_WA).norm() > 0.0)) {
    return;
  }
  std::vector<std::uint32_t> near;
  geometry_->near(nearby.bodies, p_WA, p_WB, margin_m(p_WA, p_WB, zone_m, 0.0), near);
  look_at(near, p_WA, p_WB, zone_m, found);
}

double CityObstacles::foliage_m(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                                const Eigen::Vector3d& p_WB) const {
  return nearby.leaves.empty() ? 0.0 : geometry_->foliage_m(nearby.leaves, p_WA, p_WB);
}

}  // namespace cuscus::netsim
