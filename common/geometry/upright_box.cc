#include "common/geometry/upright_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cuscus {
namespace {

/// Cuts `chord` to where a coordinate that starts at `from` and grows by `slope` is within (low,
/// high); false when nothing is left.
bool cut(Chord& chord, double from, double slope, double low, double high) {
  if (slope == 0.0) {
    return from > low && from < high;
  }
  const double at_low = (low - from) / slope;
  const double at_high = (high - from) / slope;
  chord.begin = std::max(chord.begin, std::min(at_low, at_high));
  chord.end = std::min(chord.end, std::max(at_low, at_high));
  return chord.begin < chord.end;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

UprightBox::UprightBox(const Parameters& parameters)
    : centre_m_{parameters.centre_m},
      half_m_{0.5 * parameters.size_m.head<2>()},
      height_m_{parameters.size_m.z()},
      cosine_{std::cos(parameters.heading_rad)},
      sine_{std::sin(parameters.heading_rad)} {}

Eigen::Vector3d UprightBox::in_box(const Eigen::Vector3d& p_W) const {
  const double east_m = p_W.x() - centre_m_.x();
  const double north_m = p_W.y() - centre_m_.y();
  return {cosine_ * east_m + sine_ * north_m, cosine_ * north_m - sine_ * east_m, p_W.z()};
}

bool UprightBox::contains(const Eigen::Vector3d& p_O) const {
  return std::abs(p_O.x()) < half_m_.x() && std::abs(p_O.y()) < half_m_.y() && p_O.z() < height_m_;
}

double UprightBox::distance_m(const Eigen::Vector3d& p_O) const {
  const double x_m = std::max(0.0, std::abs(p_O.x()) - half_m_.x());
  const double y_m = std::max(0.0, std::abs(p_O.y()) - half_m_.y());
  const double z_m = std::max(0.0, p_O.z() - height_m_);
  return std::sqrt(x_m * x_m + y_m * y_m + z_m * z_m);
}

std::optional<Chord> UprightBox::crossing(const Eigen::Vector3d& p_OA,
                                          const Eigen::Vector3d& p_OB) const {
  const Eigen::Vector3d way_m = p_OB - p_OA;
  Chord chord{.begin = 0.0, .end = 1.0};
  if (cut(chord, p_OA.x(), way_m.x(), -half_m_.x(), half_m_.x()) &&
      cut(chord, p_OA.y(), way_m.y(), -half_m_.y(), half_m_.y()) &&
      cut(chord, p_OA.z(), way_m.z(), -kInfinity, height_m_)) {
    return chord;
  }
  return std::nullopt;
}

std::optional<Chord> UprightBox::over_rectangle(const Eigen::Vector3d& p_OA,
                                                const Eigen::Vector3d& p_OB) const {
  const Eigen::Vector3d way_m = p_OB - p_OA;
  Chord chord{.begin = -kInfinity, .end = kInfinity};
  if (cut(chord, p_OA.x(), way_m.x(), -half_m_.x(), half_m_.x()) &&
      cut(chord, p_OA.y(), way_m.y(), -half_m_.y(), half_m_.y())) {
    return chord;
  }
  return std::nullopt;
}

}  // namespace cuscus
