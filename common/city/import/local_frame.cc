#include "common/city/import/local_frame.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>

namespace cuscus::city {

LocalFrame::LocalFrame(const Geodetic& origin)
    : origin_{origin},
      frame_{std::make_unique<GeographicLib::LocalCartesian>(origin.latitude_deg,
                                                             origin.longitude_deg, origin.height_m,
                                                             GeographicLib::Geocentric::WGS84())} {}

LocalFrame::LocalFrame(LocalFrame&&) noexcept = default;
LocalFrame& LocalFrame::operator=(LocalFrame&&) noexcept = default;
LocalFrame::~LocalFrame() = default;

Eigen::Vector3d LocalFrame::to_local(const Geodetic& point) const {
  Eigen::Vector3d local;
  frame_->Forward(point.latitude_deg, point.longitude_deg, point.height_m, local.x(), local.y(),
                  local.z());
  return local;
}

Geodetic LocalFrame::to_geodetic(const Eigen::Vector3d& point_m) const {
  Geodetic point;
  frame_->Reverse(point_m.x(), point_m.y(), point_m.z(), point.latitude_deg, point.longitude_deg,
                  point.height_m);
  return point;
}

}  // namespace cuscus::city
