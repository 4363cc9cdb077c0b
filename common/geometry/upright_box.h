#pragma once

#include <Eigen/Core>
#include <optional>

namespace cuscus {

/// The part of the line p(t) = a + t (b - a) from t = begin to t = end.
struct Chord {
  double begin;
  double end;
};

/// A box that stands on the ground: upright walls around a rectangle, under a flat roof. It has no
/// bottom: what is below its roof and within its walls belongs to it, however deep.
///
/// Its own frame O has its axes along the walls and its origin on the ground below the roof's
/// centre; in_box() goes there, everything else is asked for in O.
class UprightBox final {
 public:
  struct Parameters {
    Eigen::Vector2d centre_m{Eigen::Vector2d::Zero()};  ///< East and north.
    Eigen::Vector3d size_m{Eigen::Vector3d::Zero()};    ///< Along its x and y; height.
    double heading_rad{0.0};                            ///< Of its x, counter-clockwise from east.
  };

  explicit UprightBox(const Parameters& parameters);

  [[nodiscard]] const Eigen::Vector2d& centre_m() const { return centre_m_; }
  [[nodiscard]] const Eigen::Vector2d& half_m() const { return half_m_; }
  [[nodiscard]] double height_m() const { return height_m_; }

  /// From the world frame W into O.
  [[nodiscard]] Eigen::Vector3d in_box(const Eigen::Vector3d& p_W) const;

  /// Whether a point is inside; one on a wall or on the roof is not.
  [[nodiscard]] bool contains(const Eigen::Vector3d& p_O) const;
  /// The distance to a point outside; 0 inside.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p_O) const;
  /// What of the segment from a to b is inside; nothing where it only touches.
  [[nodiscard]] std::optional<Chord> crossing(const Eigen::Vector3d& p_OA,
                                              const Eigen::Vector3d& p_OB) const;
  /// What of the whole line through a and b is above, in or below the rectangle.
  [[nodiscard]] std::optional<Chord> over_rectangle(const Eigen::Vector3d& p_OA,
                                                    const Eigen::Vector3d& p_OB) const;

 private:
  Eigen::Vector2d centre_m_;
  Eigen::Vector2d half_m_;
  double height_m_;
  double cosine_;
  double sine_;
};

}  // namespace cuscus
