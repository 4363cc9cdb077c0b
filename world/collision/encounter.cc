#include "world/collision/encounter.h"

#include <algorithm>
#include <cmath>

namespace cuscus::world {

std::optional<double> meeting(const MovingBall& a, const MovingBall& b, double reach_m) {
  const Eigen::Vector3d apart = b.p_WC - a.p_WC;
  const Eigen::Vector3d way = (b.target - b.p_WC) - (a.target - a.p_WC);
  const double along = apart.dot(way);
  if (!(along < 0.0)) {
    return std::nullopt;  // they part, or keep their distance
  }
  const double gap = apart.squaredNorm() - reach_m * reach_m;
  if (gap <= 0.0) {
    return 0.0;
  }
  const double discriminant = along * along - way.squaredNorm() * gap;
  if (discriminant < 0.0) {
    return std::nullopt;
  }
  const double t = gap / (-along + std::sqrt(discriminant));
  return t <= 1.0 ? std::optional{t} : std::nullopt;
}

double part(MovingBall& a, const CollisionBody& body_a, MovingBall& b, const CollisionBody& body_b,
            double t) {
  const Eigen::Vector3d way_a = a.target - a.p_WC;
  const Eigen::Vector3d way_b = b.target - b.p_WC;
  const Eigen::Vector3d met_a = a.p_WC + t * way_a;
  const Eigen::Vector3d met_b = b.p_WC + t * way_b;
  Eigen::Vector3d normal = met_b - met_a;
  normal = normal.squaredNorm() > 0.0 ? normal.normalized() : Eigen::Vector3d::UnitZ();

  const double speed_mps = std::max(0.0, (a.v_mps - b.v_mps).dot(normal));
  const double restitution =
      speed_mps > kLeastBounce_mps ? std::min(restitution_of(body_a), restitution_of(body_b)) : 0.0;
  const double share_a = body_b.mass_kg / (body_a.mass_kg + body_b.mass_kg);
  const double share_b = 1.0 - share_a;
  const double lost_mps = (1.0 + restitution) * speed_mps;
  a.v_mps -= share_a * lost_mps * normal;
  b.v_mps += share_b * lost_mps * normal;

  const double rest = 1.0 - t;
  const double nearer_m = std::max(0.0, rest * (way_a - way_b).dot(normal));
  const double lost_m = (1.0 + restitution) * nearer_m;
  a.target = met_a + rest * way_a - share_a * lost_m * normal;
  b.target = met_b + rest * way_b + share_b * lost_m * normal;
  return speed_mps;
}

}  // namespace cuscus::world
