#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/city/geometry/prism_shape.h"
#include "common/city/geometry/segment.h"

namespace cuscus::city {

/// Gaps in a solid that are narrower than this along a ray are none.
inline constexpr double kSeam_m = 1e-3;

/// Where a ball that moves touches a solid.
struct Touch {
  double t{0.0};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};
};

/// The union of prisms: a building, or a wood. The rules for touching are those of CityGeometry.
class SolidShape final {
 public:
  /// `room_m`: Building::room_m.
  SolidShape(std::vector<PrismShape> prisms, double room_m);

  [[nodiscard]] const std::vector<PrismShape>& prisms() const { return prisms_; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const;

  /// Appends what the segment goes through, of these prisms of it, to `found`; false if nothing.
  bool append_crossing(const Segment& segment, std::span<const PrismShape* const> prisms,
                       std::uint32_t building, Crossings& found) const;
  [[nodiscard]] Turns turns(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] double clearance_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  /// From inside of several prisms the distance is too long where one wall is covered in part.
  [[nodiscard]] Surface surface(const Eigen::Vector3d& p) const;
  [[nodiscard]] std::optional<Touch> sweep(const Eigen::Vector3d& p, const Eigen::Vector3d& way,
                                           double radius_m) const;

 private:
  void count_inner_walls(const Segment& segment, const Intervals& parts, Crossing& crossing) const;
  [[nodiscard]] Eigen::Vector2d along_axes(const Eigen::Vector3d& p) const {
    return {p.x() * axis_.x() + p.y() * axis_.y(), p.y() * axis_.x() - p.x() * axis_.y()};
  }
  [[nodiscard]] std::optional<Surface> way_out(const Eigen::Vector3d& p) const;

  std::vector<PrismShape> prisms_;
  double room_m_;
  // The grid of inner walls.
  Eigen::Vector2d axis_{1.0, 0.0};  ///< Along the longest wall, of length 1.
  Eigen::Vector2d low_m_{Eigen::Vector2d::Zero()};
  Eigen::Vector2d high_m_{Eigen::Vector2d::Zero()};
};

}  // namespace cuscus::city
