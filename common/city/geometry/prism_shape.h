#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/city/geometry/box_tree.h"
#include "common/city/geometry/segment.h"

namespace cuscus::city {

/// Where a solid begins on a segment's way.
struct Entry {
  double t{0.0};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};  ///< Out of the solid.
};

/// A prism, and the answers of it alone. The rules for touching are those of CityGeometry.
class PrismShape final {
 public:
  /// One side of a ring: the body is on its left.
  struct Side {
    Eigen::Vector2d from;
    Eigen::Vector2d to;

    /// Of length 1, out of the body.
    [[nodiscard]] Eigen::Vector2d normal() const {
      return Eigen::Vector2d{to.y() - from.y(), from.x() - to.x()}.normalized();
    }
  };

  PrismShape(const Footprint& footprint, double bottom_m, double top_m);

  [[nodiscard]] double bottom_m() const { return bottom_m_; }
  [[nodiscard]] double top_m() const { return top_m_; }
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  /// The sides of the outer ring come first.
  [[nodiscard]] std::size_t outer_sides() const { return outer_sides_; }
  [[nodiscard]] Box box() const;

  /// Whether a point is within the footprint, seen from above.
  [[nodiscard]] bool covers(const Eigen::Vector2d& p) const { return within(p, sides_.size()); }
  /// The same, courtyards counted in.
  [[nodiscard]] bool encloses(const Eigen::Vector2d& p) const { return within(p, outer_sides_); }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    return p.z() >= bottom_m_ && p.z() < top_m_ && covers(p.head<2>());
  }

  /// Has it fetched from memory, for questions that are to come.
  void prefetch() const;
  /// Appends where the segment's line is inside, beyond the segment's ends too; parts that end
  /// before it or begin behind it may be left out.
  void append_inside(const Segment& segment, Intervals& parts) const;
  /// Appends where it is above, in or below the footprint.
  void append_over(const Segment& segment, Intervals& parts) const;
  /// Where the segment from a to b enters from outside, or 0 if it begins inside.
  [[nodiscard]] std::optional<Entry> entry(const Eigen::Vector3d& p_WA,
                                           const Eigen::Vector3d& p_WB) const;
  /// The surface's point that is nearest to one outside or inside; `surface.distance_m` tells
  /// which.
  [[nodiscard]] Surface surface(const Eigen::Vector3d& p) const;

 private:
  /// Where the line goes through a side, or through the roof or bottom (kFlat).
  struct Pass {
    double t;
    std::size_t side;
  };
  static constexpr std::size_t kFlat = static_cast<std::size_t>(-1);
  using Passes = boost::container::small_vector<Pass, 16>;

  [[nodiscard]] bool within(const Eigen::Vector2d& p, std::size_t sides) const;
  /// In ascending order, an even number. The segment is not upright.
  void append_passes(const Segment& segment, Passes& passes) const;
  /// The part of the line that is between bottom and top; empty where begin >= end.
  [[nodiscard]] Interval between_flats(const Segment& segment) const;

  std::vector<Side> sides_;
  std::size_t outer_sides_{0};
  std::vector<std::size_t> courtyard_ends_;  ///< In sides_.
  double bottom_m_;
  double top_m_;
};

}  // namespace cuscus::city
