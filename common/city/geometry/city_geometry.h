#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/city/city.h"

namespace cuscus::city {

/// What a point of a surface belongs to.
enum class Body : std::uint8_t { kBuilding, kGround, kTree, kWood };

struct Hit {
  double distance_m{0.0};  ///< From the origin. 0: the origin is in a solid, or below the ground.
  /// Of length 1, out of the body. Of an origin inside: against the direction.
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};
  Body body{Body::kGround};
  std::uint32_t index{0};  ///< In City::buildings, trees or woods; of the ground 0.
};

/// The point of a body's surface that is nearest to a point.
struct Surface {
  double distance_m{0.0};  ///< Negative: the point is inside, or below the ground.
  Eigen::Vector3d p_WS{Eigen::Vector3d::Zero()};
  /// Of length 1, out of the body, in the direction in which distance_m grows fastest.
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};
  Body body{Body::kGround};
  std::uint32_t index{0};
};

/// Where a ball that moves first touches something.
struct Contact {
  double t{0.0};  ///< Of the way from its start (0) to its end (1).
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};  ///< Of length 1, from the body to the ball.
  Body body{Body::kGround};
  std::uint32_t index{0};
};

/// Part of a segment p(t) = a + t (b - a), begin < end.
struct Interval {
  double begin{0.0};
  double end{1.0};
};

/// What a segment goes through of one building.
struct Crossing {
  std::uint32_t building{0};  ///< In City::buildings.
  std::uint32_t first{0};     ///< In Crossings::inside.
  std::uint32_t intervals{0};
  bool from_inside{false};
  bool to_inside{false};
  /// Walls, roofs and undersides between a and b: 2 intervals - from_inside - to_inside.
  std::uint32_t outer_walls{0};
  /// Walls gone through of a grid of Building::room_m that runs along the building's longest wall,
  /// and begins at the rectangle around the building with that heading.
  std::uint32_t inner_walls{0};
  /// The mean of that over all places where the grid could begin: does not jump when the ray turns.
  double mean_inner_walls{0.0};
  double level_m{0.0};   ///< Length inside, seen from above.
  double length_m{0.0};  ///< Length inside.
};

/// What a segment goes through. Kept by the caller from query to query, so that they allocate
/// nothing.
struct Crossings {
  std::vector<Crossing> buildings;  ///< By ascending index.
  std::vector<Interval> inside;     ///< Cut to [0, 1], ascending and apart within a building.

  [[nodiscard]] std::span<const Interval> of(const Crossing& crossing) const {
    return {inside.data() + crossing.first, crossing.intervals};
  }
};

/// By how much a ray from A to B must turn away from the other end to pass a building: the tangents
/// of half the angles, at A and at B, between the direct ray and the building's outermost edge on
/// that way. Infinite: there is no such way.
struct Turn {
  double at_a{std::numeric_limits<double>::infinity()};
  double at_b{std::numeric_limits<double>::infinity()};
};

struct Turns {
  Turn over;  ///< Over the roofs: in the upright plane through A and B.
  Turn left;  ///< Seen from above, from A towards B.
  Turn right;
};

/// The one geometry of a city, for radio, flight, sensors and page. It keeps no reference to the
/// City.
///
/// Metres, in the frame of the City (ENU; z up). All queries are pure and may be called from many
/// threads at once; their results do not depend on the processor. Coordinates that are not finite
/// throw std::invalid_argument.
///
/// A building is the union of its prisms: where two of them touch is no wall, gaps narrower than
/// 1 mm along a ray neither. A prism whose bottom is on the ground or below it (at any corner) goes
/// on downwards for 1 km.
///
/// Touching: walls are decided in exact arithmetic, as though a segment lay an infinitesimal to the
/// left of where it lies, seen from that end which is further west (then south), and level ones an
/// infinitesimal above it. So a ray along a wall that two buildings share is in exactly one of
/// them, one along a roof in none, and both directions of a segment find the same. What only
/// touches a corner or an edge goes through nothing. A segment that ends on a surface has not gone
/// through it from outside, and has from inside.
///
/// Trees are upright capsules, a crown over the upper two thirds of the height (a ball, where that
/// is less than its diameter) on a trunk of a tenth of its radius; woods are prisms. Both are solid
/// for flight and rays of sensors, and not in the way of crossings() and blocked().
class CityGeometry final {
 public:
  /// @throws std::invalid_argument naming the body, what is wrong with it and what is allowed.
  explicit CityGeometry(const City& city);
  CityGeometry(const CityGeometry&) = delete;
  CityGeometry& operator=(const CityGeometry&) = delete;
  CityGeometry(CityGeometry&&) noexcept;
  CityGeometry& operator=(CityGeometry&&) noexcept;
  ~CityGeometry();

  // Radio: buildings on a segment from a to b.

  /// What the segment goes through: replaces what was in `found`. A segment of length 0 that is
  /// inside has the interval [0, 1] and no walls.
  void crossings(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, Crossings& found) const;
  /// The same of one building: appends to `found`, and tells whether there was anything.
  bool append_crossing(std::uint32_t building, const Eigen::Vector3d& p_WA,
                       const Eigen::Vector3d& p_WB, Crossings& found) const;
  /// Whether there is no line of sight: any building on the segment, or an end inside one.
  [[nodiscard]] bool blocked(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const;
  /// Whether the ground is on the segment, or an end below it.
  [[nodiscard]] bool behind_ground(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const;
  /// The buildings that come as near to the segment as `margin_m` or nearer, the crossed ones
  /// included; also some that do not (their boxes do). By ascending index; replaces `buildings`.
  void near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double margin_m,
            std::vector<std::uint32_t>& buildings) const;
  /// What near() and foliage_m() of segments may find whose ends are known to stay about where they
  /// are: the prisms, or trees and woods, that come as near to this one as `margin_m`, each by a
  /// number of its own. Some do not (their boxes do). Replaces `prisms` or `plants`.
  void prisms_near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double margin_m,
                   std::vector<std::uint32_t>& prisms) const;
  void plants_near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double margin_m,
                   std::vector<std::uint32_t>& plants) const;
  /// near(), to the same buildings, where all prisms so near to the segment are among `prisms`.
  void near(std::span<const std::uint32_t> prisms, const Eigen::Vector3d& p_WA,
            const Eigen::Vector3d& p_WB, double margin_m,
            std::vector<std::uint32_t>& buildings) const;
  /// The ways past a building that the segment crosses, both ends outside. Over: by its roofs'
  /// edges in the plane, as far as they are above the segment and of parts that the segment is
  /// above, in or below between its ends. Left and right: by the corners of those parts of its
  /// prisms at whose height the line is there. No way beneath.
  [[nodiscard]] Turns turns(std::uint32_t building, const Eigen::Vector3d& p_WA,
                            const Eigen::Vector3d& p_WB) const;
  /// How much longer than the segment the path by way of the building's nearest point is, to second
  /// order [m]: the least D² (1/d_A + 1/d_B) / 2 along it, D the distance from it to the building.
  /// 0 of a building that the segment crosses or touches.
  [[nodiscard]] double clearance_m(std::uint32_t building, const Eigen::Vector3d& p_WA,
                                   const Eigen::Vector3d& p_WB) const;
  /// Length of the segment within crowns of trees and within woods (ITU-R P.833); where several
  /// overlap it counts once.
  [[nodiscard]] double foliage_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const;
  /// The same to the bit, where all plants on the segment are among `plants`.
  [[nodiscard]] double foliage_m(std::span<const std::uint32_t> plants, const Eigen::Vector3d& p_WA,
                                 const Eigen::Vector3d& p_WB) const;

  // Flight and sensors: all bodies.

  /// The first surface from the origin on, at most `range_m` (may be infinite) away.
  /// @throws std::invalid_argument also for a direction of length 0; any other length will do.
  [[nodiscard]] std::optional<Hit> first_hit(const Eigen::Vector3d& p_WO,
                                             const Eigen::Vector3d& direction,
                                             double range_m) const;
  /// first_hit() in each of `directions`: its distance, or infinity.
  void ranges(const Eigen::Vector3d& p_WO, std::span<const Eigen::Vector3d> directions,
              double range_m, std::span<double> distances_m) const;
  /// The nearest surface of all; none where all are further than `radius_m` away. A point that is
  /// inside a body has that body's (the deepest, if in several), however far its surface is.
  [[nodiscard]] std::optional<Surface> nearest(const Eigen::Vector3d& p_W, double radius_m) const;
  /// The nearest surface of every body within `radius_m`, in a fixed order; replaces `surfaces`.
  void surfaces(const Eigen::Vector3d& p_W, double radius_m, std::vector<Surface>& surfaces) const;
  /// The first contact of a ball whose centre moves from p to q: exact, whatever the step. One that
  /// touches something already, or is in it, has contact at 0 if it moves deeper, and none with it
  /// if not: so it can leave, and slide.
  [[nodiscard]] std::optional<Contact> sweep(const Eigen::Vector3d& p_WP,
                                             const Eigen::Vector3d& p_WQ, double radius_m) const;

  /// The building that a point is in.
  [[nodiscard]] std::optional<std::uint32_t> inside(const Eigen::Vector3d& p_W) const;
  /// Height of the ground: of the terrain, bilinear, and beyond its rim that of the rim; else 0.
  [[nodiscard]] double ground_m(const Eigen::Vector2d& p_W) const;
  /// Free height up to the next surface above; infinite below open sky, 0 inside a body.
  [[nodiscard]] double free_above_m(const Eigen::Vector3d& p_W) const;
  /// Free height down to the next surface below (ground, roof, crown); 0 inside a body.
  [[nodiscard]] double free_below_m(const Eigen::Vector3d& p_W) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace cuscus::city
