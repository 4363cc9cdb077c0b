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

}  // namespace cuscus::netsim
