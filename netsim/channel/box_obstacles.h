#pragma once

#include <vector>

#include "common/geometry/upright_box.h"
#include "netsim/channel/obstacles.h"

namespace cuscus::netsim {

/// A box with outer walls and a roof of one material and, evenly spaced within it, inner walls
/// along both of its axes.
struct BoxObstacle {
  UprightBox::Parameters shape{};
  Decibel outer_wall{12.0};     ///< Of one wall, and of the roof.
  double inner_spacing_m{0.0};  ///< 0: no inner walls.
  Decibel inner_wall{0.0};      ///< Of one.
};

/// A list of boxes. They may overlap; each counts for itself.
///
/// `WallCount::inner` counts the walls of the grid that the ray goes through. Their loss is that of
/// the mean number of them over all places where the grid could begin, (|Δx| + |Δy|) / spacing,
/// with Δ the ray's way inside along the box's axes: so it does not jump when the ray turns.
class BoxObstacles final : public Obstacles {
 public:
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  explicit BoxObstacles(const std::vector<BoxObstacle>& boxes);

  void find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
            std::vector<Obstruction>& found) const override;
  void look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                   double slack_m, Nearby& nearby) const override;
  void find(const Nearby& nearby, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
            double zone_m, std::vector<Obstruction>& found) const override;

 private:
  struct Body {
    UprightBox box;
    double radius_m;  ///< Of a circle around its rectangle.
    Decibel outer_wall;
    double inner_spacing_m;
    Decibel inner_wall;
  };

  [[nodiscard]] static bool may_matter(const Body& body, const Eigen::Vector3d& p_WA,
                                       const Eigen::Vector3d& p_WB, double margin_m);
  /// Appends what the body does to the ray, if anything.
  static void look_at(const Body& body, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                      double zone_m, std::vector<Obstruction>& found);
  [[nodiscard]] static Obstruction crossed(const Body& body, const Eigen::Vector3d& p_OA,
                                           const Eigen::Vector3d& p_OB, const Chord& inside);

  std::vector<Body> bodies_;
};

}  // namespace cuscus::netsim
