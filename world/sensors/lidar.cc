#include "world/sensors/lidar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "world/sensors/white_noise.h"

namespace cuscus::world {
namespace {

const Eigen::Vector3d kLidarPlace_B_m{0.0, 0.0, 0.1};
/// Less than this short of a whole turn is a whole turn.
constexpr double kWholeTurnSlack_rad = 1e-6;

}  // namespace

double lidar_azimuth_rad(const LidarParameters& parameters, std::uint32_t k) {
  const bool whole = parameters.field_rad > 2.0 * std::numbers::pi - kWholeTurnSlack_rad;
  const std::uint32_t steps = whole ? parameters.rays : parameters.rays - 1;
  return steps == 0 ? 0.0 : parameters.field_rad * (static_cast<double>(k) / steps - 0.5);
}

Lidar::Lidar(std::uint64_t seed, std::uint32_t node, const LidarParameters& parameters)
    : noise_{seed, random::stream_id(NoisePurpose::kLidar, node)},
      range_m_{parameters.range_m},
      noise_m_{parameters.noise_m} {
  rays_B_.reserve(parameters.rays * parameters.elevations_rad.size());
  for (const double elevation_rad : parameters.elevations_rad) {
    for (std::uint32_t k = 0; k < parameters.rays; ++k) {
      const double azimuth_rad = lidar_azimuth_rad(parameters, k);
      rays_B_.emplace_back(std::cos(elevation_rad) * std::cos(azimuth_rad),
                           std::cos(elevation_rad) * std::sin(azimuth_rad),
                           std::sin(elevation_rad));
    }
  }
}

void Lidar::sample(const Surroundings& surroundings, const RigidBodyState& body,
                   std::uint64_t reading, std::span<float> ranges_m) const {
  const Eigen::Vector3d p_WS = body.p_WB_m + body.q_WB * kLidarPlace_B_m;
  const Eigen::Matrix3d R_WB = body.q_WB.toRotationMatrix();
  for (std::size_t k = 0; k < rays_B_.size(); ++k) {
    const auto hit = surroundings.first_hit(p_WS, R_WB * rays_B_[k], range_m_);
    if (!hit) {
      ranges_m[k] = std::numeric_limits<float>::infinity();
      continue;
    }
    const double error_m = noise_m_ * noise_.normal(reading * rays_B_.size() + k);
    ranges_m[k] = static_cast<float>(std::clamp(hit->distance_m + error_m, 0.0, range_m_));
  }
}

}  // namespace cuscus::world
