#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/units/decibel.h"

namespace cuscus::netsim {

/// Walls between the ends of a link: n_W and n_w of the CUSCUS paper's equation 1.
struct WallCount {
  std::uint32_t outer{0};
  std::uint32_t inner{0};
};

/// Ways past a body that stands on the ground, left and right as seen from A towards B.
inline constexpr std::size_t kWays = 3;
enum class Way : std::uint8_t { kOver, kLeft, kRight };

/// By how much a ray from A to B must turn away from the other end to pass a body: the tangents of
/// half the angles at A and B between the direct ray and the body's outermost edge on that way.
/// Over: in the upright plane through A and B. Left and right: seen from above. Infinite: there is
/// no such way.
struct Turn {
  double at_a{std::numeric_limits<double>::infinity()};
  double at_b{std::numeric_limits<double>::infinity()};
};

/// What one body does to a link from A to B.
struct Obstruction {
  bool crossed{false};  ///< Whether the direct ray goes through it.
  // Of a body that is crossed.
  WallCount walls{};
  Decibel outer_loss{};  ///< Of its outer walls, by their material.
  Decibel inner_loss{};
  std::array<Turn, kWays> turns{};  ///< By Way; all infinite where an end is inside.
  // Of one that is not.
  /// How much longer than the direct ray a path by way of its nearest point is, to second order
  /// [m]: the least D² (1/d_A + 1/d_B) / 2 along the ray, D the distance from the ray to the body.
  double clearance_m{0.0};
};

/// What rays may meet whose ends stay about where they are: numbers that mean something to whom
/// they come from.
struct Nearby {
  std::vector<std::uint32_t> bodies;
  std::vector<std::uint32_t> leaves;
  std::vector<Nearby> parts;  ///< Of several kinds of obstacles: one by one.
};

/// The bodies of a scenario, whatever they come from. Pure functions: may be shared by threads.
class Obstacles {
 public:
  virtual ~Obstacles() = default;

  /// Appends what is on the direct ray from A to B, or near it, to `found`, in an order that does
  /// not depend on the ray. A body that is cleared by `zone_m` or more may be left out.
  virtual void find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                    std::vector<Obstruction>& found) const = 0;
  /// How far the direct ray goes through leaves.
  [[nodiscard]] virtual double foliage_m(const Eigen::Vector3d& /*p_WA*/,
                                         const Eigen::Vector3d& /*p_WB*/) const {
    return 0.0;
  }

  /// Replaces `nearby` by what may matter to rays whose ends are at most `slack_m` from A and B.
  virtual void look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                           double slack_m, Nearby& nearby) const = 0;
  /// find() and foliage_m() of such a ray, without a search: the same to the bit.
  virtual void find(const Nearby& nearby, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                    double zone_m, std::vector<Obstruction>& found) const = 0;
  [[nodiscard]] virtual double foliage_m(const Nearby& /*nearby*/, const Eigen::Vector3d& /*p_WA*/,
                                         const Eigen::Vector3d& /*p_WB*/) const {
    return 0.0;
  }

 protected:
  /// A body further than this from the direct ray clears it by `zone_m`, whichever the ray is whose
  /// ends are at most `slack_m` from A and B.
  [[nodiscard]] static double margin_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                                       double zone_m, double slack_m);
};

inline double Obstacles::margin_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                                  double zone_m, double slack_m) {
  // D² (1/d_A + 1/d_B) / 2 is least in the middle: D² 2 / length.
  return std::sqrt(zone_m * ((p_WB - p_WA).norm() + 2.0 * slack_m) / 2.0);
}

}  // namespace cuscus::netsim
