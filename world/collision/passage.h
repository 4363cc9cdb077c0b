#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "world/collision/collision_body.h"
#include "world/surroundings/surroundings.h"

namespace cuscus::world {

/// One contact on a ball's way.
struct Impact {
  city::Contact contact;
  double speed_mps{0.0};  ///< Into the surface.
};

/// Where a ball gets in one step, given where it would get if nothing were in the way.
struct Passage {
  static constexpr std::size_t kMostImpacts = 8;

  Eigen::Vector3d p_WC;                      ///< Its centre.
  Eigen::Vector3d v_WC_mps;                  ///< After all impacts.
  bool rests{false};                         ///< It has come down on something that carries it.
  std::array<Impact, kMostImpacts> impacts;  ///< In order.
  std::size_t impact_count{0};
};

/// Moves a ball's centre from `p_WC` to `target`, at `v_mps`, with all that it meets. With n the
/// normal at a contact and e the restitution, which is 0 below kLeastBounce_mps,
///
///   v += (1 + e) (v · n)⁻ n,   (x)⁻ = max(0, −x)
///
/// and what remains of the way likewise: it goes on along the surface, without friction, until it
/// meets another. On what is less steep than 45° (and e = 0) it stops for good instead. After
/// kMostImpacts it waits where it is for the next step.
///
/// Each part of the way is swept, so nothing is thin enough to be passed.
[[nodiscard]] Passage passage(const Surroundings& surroundings, const CollisionBody& body,
                              const Eigen::Vector3d& p_WC, const Eigen::Vector3d& target,
                              const Eigen::Vector3d& v_mps);

}  // namespace cuscus::world
