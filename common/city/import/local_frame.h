#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/city/city.h"

// NOLINTNEXTLINE(readability-identifier-naming): its name
namespace GeographicLib {
class LocalCartesian;
}

namespace cuscus::city {

/// WGS-84 to east, north and up in the plane that touches the ellipsoid's parallel surface at
/// `origin`, and back. Exact (a rotation of earth-centred coordinates), unlike a map projection.
class LocalFrame {
 public:
  /// `origin` has finite numbers, and a latitude in [-90, 90].
  explicit LocalFrame(const Geodetic& origin);
  LocalFrame(const LocalFrame&) = delete;
  LocalFrame& operator=(const LocalFrame&) = delete;
  LocalFrame(LocalFrame&&) noexcept;
  LocalFrame& operator=(LocalFrame&&) noexcept;
  ~LocalFrame();

  [[nodiscard]] const Geodetic& origin() const noexcept { return origin_; }

  [[nodiscard]] Eigen::Vector3d to_local(const Geodetic& point) const;
  [[nodiscard]] Geodetic to_geodetic(const Eigen::Vector3d& point_m) const;

 private:
  Geodetic origin_;
  std::unique_ptr<const GeographicLib::LocalCartesian> frame_;
};

}  // namespace cuscus::city
