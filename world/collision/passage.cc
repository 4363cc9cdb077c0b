#include "world/collision/passage.h"

#include <algorithm>

namespace cuscus::world {
namespace {

/// A way along a surface leaves it by this much, so that rounding cannot make it go in.
constexpr double kLift_m = 1e-9;

/// Puts a ball that has come to rest exactly on what carries it.
void settle(const Surroundings& surroundings, double radius_m, Eigen::Vector3d& p_WC) {
  if (const auto surface = surroundings.nearest(p_WC, radius_m + kLift_m)) {
    p_WC += (radius_m - surface->distance_m) * surface->normal;
  }
}

}  // namespace

Passage passage(const Surroundings& surroundings, const CollisionBody& body,
                const Eigen::Vector3d& p_WC, const Eigen::Vector3d& target,
                const Eigen::Vector3d& v_mps) {
  Passage result{.p_WC = p_WC, .v_WC_mps = v_mps, .impacts = {}};
  Eigen::Vector3d way = target - p_WC;
  while (result.impact_count < Passage::kMostImpacts) {
    const auto contact = surroundings.sweep(result.p_WC, result.p_WC + way, body.radius_m);
    if (!contact) {
      result.p_WC += way;
      return result;
    }
    const Eigen::Vector3d& normal = contact->normal;
    const double speed_mps = std::max(0.0, -result.v_WC_mps.dot(normal));
    const double restitution = speed_mps > kLeastBounce_mps ? restitution_of(body) : 0.0;
    result.impacts[result.impact_count++] = {.contact = *contact, .speed_mps = speed_mps};
    result.p_WC += contact->t * way;
    if (carries(normal) && restitution == 0.0) {
      result.v_WC_mps.setZero();
      result.rests = true;
      settle(surroundings, body.radius_m, result.p_WC);
      return result;
    }
    result.v_WC_mps += (1.0 + restitution) * speed_mps * normal;
    if (body.loses_all_speed) {
      result.v_WC_mps.setZero();
    }
    way *= 1.0 - contact->t;
    way += ((1.0 + restitution) * std::max(0.0, -way.dot(normal)) + kLift_m) * normal;
  }
  return result;
}

}  // namespace cuscus::world
