#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/city/city.h"
#include "common/city/geometry/city_geometry.h"
#include "netsim/channel/obstacles.h"
#include "netsim/channel/wall_loss.h"

namespace cuscus::netsim {

/// The buildings, trees and woods of a city.
class CityObstacles final : public Obstacles {
 public:
  /// `geometry` is of `city`, of which walls' materials are taken.
  CityObstacles(const city::City& city, std::shared_ptr<const city::CityGeometry> geometry,
                const WallLosses& walls);

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
  void look_at(std::span<const std::uint32_t> near, const Eigen::Vector3d& p_WA,
               const Eigen::Vector3d& p_WB, double zone_m, std::vector<Obstruction>& found) const;
  [[nodiscard]] Obstruction crossed(const city::Crossing& crossing, const Eigen::Vector3d& p_WA,
                                    const Eigen::Vector3d& p_WB) const;

  std::shared_ptr<const city::CityGeometry> geometry_;
  std::vector<Decibel> outer_wall_;  ///< By building.
  Decibel inner_wall_;
  bool has_foliage_;
};

}  // namespace cuscus::netsim
