#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "netsim/channel/obstacles.h"

namespace cuscus::netsim {

/// Several kinds of obstacles at once. Each counts for itself.
class AllObstacles final : public Obstacles {
 public:
  explicit AllObstacles(std::vector<std::shared_ptr<const Obstacles>> all) : all_{std::move(all)} {}

  void find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
            std::vector<Obstruction>& found) const override;
  [[nodiscard]] double foliage_m(const Eigen::Vector3d& p_WA,
                                 const Eigen::Vector3d& p_WB) const override;
  void look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                   double slack_m, Nearby& nearby) const override;
  void find(const Nearby& nearby, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
            double zone_m, std::vector<Obstruction>& found) const override;
  [[nodiscard]] double foliage_m(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                                 const Eigen::Vector3d& p_WB) const override;

 private:
  std::vector<std::shared_ptr<const Obstacles>> all_;
};

}  // namespace cuscus::netsim
