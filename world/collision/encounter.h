#pragma once

#include <Eigen/Core>
#include <optional>

#include "world/collision/collision_body.h"

namespace cuscus::world {

/// A ball on its way through one step: its centre goes straight from p_WC to target.
struct MovingBall {
  Eigen::Vector3d p_WC;
  Eigen::Vector3d target;
  Eigen::Vector3d v_mps;
};

/// When two balls of radii that sum to `reach_m` first touch, of the step (0 ... 1): the smaller
/// root of |d + t (w_b − w_a)|² = reach², d from a to b, w their ways. 0 for balls that overlap and
/// come nearer; nothing for those that part.
[[nodiscard]] std::optional<double> meeting(const MovingBall& a, const MovingBall& b,
                                            double reach_m);

/// Lets two balls that meet at `t` part: along the line of centres, an impulse changes their
/// relative speed u into −e u, with e the smaller of both restitutions (0 below kLeastBounce_mps),
/// and keeps their momentum; what remains of their ways changes likewise. Returns u [m/s]. Balls
/// whose centres coincide part upwards and downwards.
double part(MovingBall& a, const CollisionBody& body_a, MovingBall& b, const CollisionBody& body_b,
            double t);

}  // namespace cuscus::world
