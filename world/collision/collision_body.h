#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace cuscus::world {

enum class CollisionBehaviour : std::uint8_t {
  kStop,    ///< Loses the speed into what it hits, and slides along it.
  kBounce,  ///< Comes back with part of that speed.
  kCrash,   ///< As kStop, and its motors never run again.
};

/// What hits and is hit of a vehicle: a ball that stands on its position, its centre that much
/// above, so that a vehicle which stands on something is where that something is.
struct CollisionBody {
  double radius_m{0.0};  ///< 0: a point, which other vehicles do not meet.
  double mass_kg{1.0};
  CollisionBehaviour behaviour{CollisionBehaviour::kStop};
  double restitution{0.0};  ///< Of kBounce: speed after over speed before.
  /// As FL-AIR, where a contact makes the last two positions the same: all speed is lost.
  bool loses_all_speed{false};
};

[[nodiscard]] inline double restitution_of(const CollisionBody& body) {
  return body.behaviour == CollisionBehaviour::kBounce ? body.restitution : 0.0;
}

/// A body slower than this into a surface does not come back from it: it would for ever, each time
/// less.
inline constexpr double kLeastBounce_mps = 0.1;

/// Cosine of 45 degrees: on what is less steep a vehicle stands, and so far it may tilt.
inline constexpr double kStandingCosine = 0.70710678118654752;

/// What is up to this fast downwards and upright lands; it does not crash.
inline constexpr double kLandingSpeed_mps = 2.0;

[[nodiscard]] inline bool carries(const Eigen::Vector3d& normal) {
  return normal.z() > kStandingCosine;
}

}  // namespace cuscus::world
