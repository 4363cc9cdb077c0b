#include "world/surroundings/surroundings.h"

#include <algorithm>

namespace cuscus::world {

std::optional<city::Hit> Surroundings::first_hit(const Eigen::Vector3d& p_WO,
                                                 const Eigen::Vector3d& direction,
                                                 double range_m) const {
  if (city_ != nullptr) {
    return city_->first_hit(p_WO, direction, range_m);
  }
  const Eigen::Vector3d ahead = direction.normalized();
  if (p_WO.z() <= 0.0) {
    return city::Hit{.distance_m = 0.0, .normal = -ahead};
  }
  const double distance_m = p_WO.z() / -ahead.z();
  if (ahead.z() >= 0.0 || distance_m > range_m) {
    return std::nullopt;
  }
  return city::Hit{.distance_m = distance_m};
}

std::optional<city::Surface> Surroundings::nearest(const Eigen::Vector3d& p_W,
                                                   double radius_m) const {
  if (city_ != nullptr) {
    return city_->nearest(p_W, radius_m);
  }
  if (p_W.z() > radius_m) {
    return std::nullopt;
  }
  return city::Surface{.distance_m = p_W.z(), .p_WS = {p_W.x(), p_W.y(), 0.0}};
}

std::optional<city::Contact> Surroundings::sweep(const Eigen::Vector3d& p_WP,
                                                 const Eigen::Vector3d& p_WQ,
                                                 double radius_m) const {
  if (city_ != nullptr) {
    return city_->sweep(p_WP, p_WQ, radius_m);
  }
  const double sinks_m = p_WP.z() - p_WQ.z();
  const double free_m = p_WP.z() - radius_m;
  if (sinks_m <= 0.0 || free_m > sinks_m) {
    return std::nullopt;
  }
  return city::Contact{.t = std::max(free_m, 0.0) / sinks_m};
}

std::optional<double> Surroundings::foliage_to_sky_m(const Eigen::Vector3d& p_WO,
                                                     const Eigen::Vector3d& direction) const {
  // Longer than any way through a city, which has 100 km at most.
  constexpr double kWayOut_m = 200e3;
  if (direction.z() <= 0.0 || p_WO.z() < ground_m(p_WO.head<2>())) {
    return std::nullopt;
  }
  if (city_ == nullptr) {
    return 0.0;
  }
  const Eigen::Vector3d p_WQ = p_WO + kWayOut_m * direction;
  if (city_->blocked(p_WO, p_WQ) || city_->behind_ground(p_WO, p_WQ)) {
    return std::nullopt;
  }
  return city_->foliage_m(p_WO, p_WQ);
}

}  // namespace cuscus::world
