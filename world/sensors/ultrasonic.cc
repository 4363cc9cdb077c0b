#include "world/sensors/ultrasonic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/sensors/white_noise.h"

namespace cuscus::world {
namespace {

const Eigen::Vector3d kUltrasonicPlace_B_m{0.0, 0.0, 0.04};
constexpr int kRings = 3;
constexpr int kRaysOfFirstRing = 8;

/// Rays evenly around `axis` on rings of evenly growing angles, the axis first.
std::vector<Eigen::Vector3d> bundle(const Eigen::Vector3d& axis, double half_angle_rad) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d other = axis.cross(across);
  std::vector<Eigen::Vector3d> rays{axis};
  for (int ring = 1; ring <= kRings; ++ring) {
    const double angle_rad = half_angle_rad * ring / kRings;
    const int count = kRaysOfFirstRing * ring;
    for (int i = 0; i < count; ++i) {
      const double around_rad = 2.0 * std::numbers::pi * i / count;
      rays.emplace_back(std::cos(angle_rad) * axis +
                        std::sin(angle_rad) *
                            (std::cos(around_rad) * across + std::sin(around_rad) * other));
    }
  }
  return rays;
}

}  // namespace

Ultrasonic::Ultrasonic(std::uint64_t seed, std::uint32_t node,
                       const UltrasonicParameters& parameters)
    : noise_{seed, random::stream_id(NoisePurpose::kUltrasonic, node)},
      parameters_{parameters},
      rays_B_{bundle(parameters.axis_B, parameters.half_angle_rad)} {}

std::optional<double> Ultrasonic::sample(const Surroundings& surroundings,
                                         const RigidBodyState& body, std::uint64_t reading) const {
  const auto truth_m = distance_m(surroundings, body);
  if (!truth_m) {
    return std::nullopt;
  }
  return std::clamp(*truth_m + parameters_.noise_m * noise_.normal(reading), 0.0,
                    parameters_.range_m);
}

std::optional<double> Ultrasonic::distance_m(const Surroundings& surroundings,
                                             const RigidBodyState& body) const {
  const Eigen::Vector3d p_WS = body.p_WB_m + body.q_WB * kUltrasonicPlace_B_m;
  const auto nearest = surroundings.nearest(p_WS, parameters_.range_m);
  if (!nearest) {
    return std::nullopt;
  }
  if (nearest->distance_m <= 0.0) {
    return 0.0;
  }
  const Eigen::Vector3d axis_W = body.q_WB * parameters_.axis_B;
  const double along_m = (nearest->p_WS - p_WS).dot(axis_W);
  if (along_m >= nearest->distance_m * std::cos(parameters_.half_angle_rad)) {
    return nearest->distance_m;
  }
  std::optional<double> least_m;
  for (const Eigen::Vector3d& ray_B : rays_B_) {
    const auto hit = surroundings.first_hit(p_WS, body.q_WB * ray_B, parameters_.range_m);
    if (hit && (!least_m || hit->distance_m < *least_m)) {
      least_m = hit->distance_m;
    }
  }
  return least_m;
}

}  // namespace cuscus::world
