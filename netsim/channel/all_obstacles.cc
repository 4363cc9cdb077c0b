#include "netsim/channel/all_obstacles.h"

namespace cuscus::netsim {

void AllObstacles::find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                        std::vector<Obstruction>& found) const {
  for (const auto& obstacles : all_) {
    obstacles->find(p_WA, p_WB, zone_m, found);
  }
}

double AllObstacles::foliage_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const {
  double length_m = 0.0;
  for (const auto& obstacles : all_) {
    length_m += obstacles->foliage_m(p_WA, p_WB);
  }
  return length_m;
}

void AllObstacles::look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                               double zone_m, double slack_m, Nearby& nearby) const {
  nearby.parts.resize(all_.size());
  for (std::size_t i = 0; i < all_.size(); ++i) {
    all_[i]->look_around(p_WA, p_WB, zone_m, slack_m, nearby.parts[i]);
  }
}

void AllObstacles::find(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                        const Eigen::Vector3d& p_WB, double zone_m,
                        std::vector<Obstruction>& found) const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    all_[i]->find(nearby.parts[i], p_WA, p_WB, zone_m, found);
  }
}

double AllObstacles::foliage_m(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                               const Eigen::Vector3d& p_WB) const {
  double length_m = 0.0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    length_m += all_[i]->foliage_m(nearby.parts[i], p_WA, p_WB);
  }
  return length_m;
}

}  // namespace cuscus::netsim
