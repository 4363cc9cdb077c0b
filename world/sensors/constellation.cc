#include "world/sensors/constellation.h"

#include <cmath>
#include <numbers>

namespace cuscus::world {
namespace {

using std::numbers::pi;

constexpr double kDegree_rad = pi / 180.0;

// WGS-84.
constexpr double kEarthRate_radps = 7.292115e-5;
constexpr double kEarthGm_m3ps2 = 3.986004418e14;
constexpr double kSemiMajorAxis_m = 6'378'137.0;
constexpr double kFlattening = 1.0 / 298.257223563;

// Of all slots.
constexpr double kInclination_rad = 55.0 * kDegree_rad;
constexpr std::chrono::sys_days kReference{std::chrono::year{1993} / 7 / 1};
constexpr double kReferenceGreenwich_rad =
    (18.0 + 36.0 / 60.0 + 14.4 / 3600.0) * 15.0 * kDegree_rad;

/// A plane's right ascension, and its slots' arguments of latitude.
struct Plane {
  double ascension_deg;
  std::array<double, 4> latitudes_deg;
};
constexpr std::array<Plane, 6> kPlanes{{{272.847, {268.126, 161.786, 11.676, 41.806}},
                                        {332.847, {80.956, 173.336, 309.976, 204.376}},
                                        {32.847, {111.876, 11.796, 339.666, 241.556}},
                                        {92.847, {135.226, 265.446, 35.156, 167.356}},
                                        {152.847, {197.046, 302.596, 66.066, 333.686}},
                                        {212.847, {238.886, 345.226, 105.206, 135.346}}}};

Eigen::Vector3d earth_fixed(const city::Geodetic& site) {
  const double latitude_rad = site.latitude_deg * kDegree_rad;
  const double longitude_rad = site.longitude_deg * kDegree_rad;
  const double eccentricity2 = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(latitude_rad);
  const double normal_m = kSemiMajorAxis_m / std::sqrt(1.0 - eccentricity2 * sine * sine);
  const double level_m = (normal_m + site.height_m) * std::cos(latitude_rad);
  return {level_m * std::cos(longitude_rad), level_m * std::sin(longitude_rad),
          (normal_m * (1.0 - eccentricity2) + site.height_m) * sine};
}

/// Rows: east, north and up at `site`.
Eigen::Matrix3d local_axes(const city::Geodetic& site) {
  const double latitude_rad = site.latitude_deg * kDegree_rad;
  const double longitude_rad = site.longitude_deg * kDegree_rad;
  const double sin_b = std::sin(latitude_rad);
  const double cos_b = std::cos(latitude_rad);
  const double sin_l = std::sin(longitude_rad);
  const double cos_l = std::cos(longitude_rad);
  Eigen::Matrix3d axes;
  axes << -sin_l, cos_l, 0.0,                 //
      -sin_b * cos_l, -sin_b * sin_l, cos_b,  //
      cos_b * cos_l, cos_b * sin_l, sin_b;
  return axes;
}

}  // namespace

Constellation::Constellation(const city::Geodetic& site, std::chrono::sys_seconds epoch)
    : p_ES_m_{earth_fixed(site)},
      R_WE_{local_axes(site)},
      since_reference_s_{static_cast<double>((epoch - kReference).count())} {}

std::array<Eigen::Vector3d, kSatellites> Constellation::directions(SimTime time) const {
  const double turned_rad =
      kEarthRate_radps * (since_reference_s_ + to_seconds(time.time_since_epoch()));
  const double radius_m = std::cbrt(kEarthGm_m3ps2 / (4.0 * kEarthRate_radps * kEarthRate_radps));
  std::array<Eigen::Vector3d, kSatellites> directions;
  std::size_t satellite = 0;
  for (const auto& [ascension_deg, latitudes_deg] : kPlanes) {
    const double node_rad = ascension_deg * kDegree_rad - kReferenceGreenwich_rad - turned_rad;
    const double cos_node = std::cos(node_rad);
    const double sin_node = std::sin(node_rad);
    for (const double latitude_deg : latitudes_deg) {
      const double u_rad = latitude_deg * kDegree_rad + 2.0 * turned_rad;
      const double along = std::cos(u_rad);
      const double across = std::sin(u_rad) * std::cos(kInclination_rad);
      const Eigen::Vector3d p_E_m =
          radius_m * Eigen::Vector3d{along * cos_node - across * sin_node,
                                     along * sin_node + across * cos_node,
                                     std::sin(u_rad) * std::sin(kInclination_rad)};
      directions[satellite++] = (R_WE_ * (p_E_m - p_ES_m_)).normalized();
    }
  }
  return directions;
}

}  // namespace cuscus::world
