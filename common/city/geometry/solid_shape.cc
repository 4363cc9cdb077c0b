#include "common/city/geometry/solid_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cuscus::city {
namespace {

/// Walls of a grid, which begins at the outer wall `low`, between two coordinates.
std::uint32_t walls_between(double from_m, double to_m, double low_m, double high_m,
                            double room_m) {
  const double walls = std::max(0.0, std::ceil((high_m - low_m) / room_m) - 1.0);
  const auto room = [&](double x_m) {
    return std::clamp(std::floor((x_m - low_m) / room_m), 0.0, walls);
  };
  return static_cast<std::uint32_t>(std::abs(room(to_m) - room(from_m)));
}

}  // namespace

SolidShape::SolidShape(std::vector<PrismShape> prisms, double room_m)
    : prisms_{std::move(prisms)}, room_m_{room_m} {
  if (room_m_ == 0.0) {
    return;
  }
  double longest_m = 0.0;
  for (const PrismShape& prism : prisms_) {
    for (const PrismShape::Side& side : prism.sides()) {
      const Eigen::Vector2d along = side.to - side.from;
      // Of sides that are equal but for rounding the first.
      if (along.norm() > longest_m * (1.0 + 1e-9)) {
        longest_m = along.norm();
        axis_ = along / longest_m;
      }
    }
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  low_m_.setConstant(kInfinity);
  high_m_.setConstant(-kInfinity);
  for (const PrismShape& prism : prisms_) {
    for (const PrismShape::Side& side : prism.sides()) {
      const Eigen::Vector2d p = along_axes({side.from.x(), side.from.y(), 0.0});
      low_m_ = low_m_.cwiseMin(p);
      high_m_ = high_m_.cwiseMax(p);
    }
  }
}

bool SolidShape::contains(const Eigen::Vector3d& p) const {
  return std::any_of(prisms_.begin(), prisms_.end(),
                     [&p](const PrismShape& prism) { return prism.contains(p); });
}

bool SolidShape::append_crossing(const Segment& segment, std::span<const PrismShape* const> prisms,
                                 std::uint32_t building, Crossings& found) const {
  Intervals parts;
  for (const PrismShape* prism : prisms) {
    prism->append_inside(segment, parts);
  }
  if (parts.empty()) {
    return false;
  }
  const Eigen::Vector3d way = segment.b - segment.a;
  const double length_m = way.norm();
  // Below 1: parts on either side of a short segment are no part of it.
  unite(parts, length_m > 0.0 ? std::min(kSeam_m / length_m, 0.999) : 0.0);
  Crossing crossing{.building = building};
  for (const Interval& part : parts) {
    crossing.from_inside = crossing.from_inside || (part.begin < 0.0 && part.end > 0.0);
    crossing.to_inside = crossing.to_inside || (part.begin < 1.0 && part.end > 1.0);
  }
  cut_to_segment(parts);
  if (parts.empty()) {
    return false;
  }
  crossing.first = static_cast<std::uint32_t>(found.inside.size());
  crossing.intervals = static_cast<std::uint32_t>(parts.size());
  crossing.outer_walls =
      2 * crossing.intervals - (crossing.from_inside ? 1U : 0U) - (crossing.to_inside ? 1U : 0U);
  double share = 0.0;
  for (const Interval& part : parts) {
    share += part.end - part.begin;
    found.inside.push_back(segment.asked_for(part));
  }
  if (segment.reversed) {
    std::swap(crossing.from_inside, crossing.to_inside);
    std::reverse(found.inside.begin() + crossing.first, found.inside.end());
  }
  crossing.length_m = share * length_m;
  crossing.level_m = share * way.head<2>().norm();
  if (room_m_ > 0.0) {
    count_inner_walls(segment, parts, crossing);
  }
  found.buildings.push_back(crossing);
  return true;
}

void SolidShape::count_inner_walls(const Segment& segment, const Intervals& parts,
                                   Crossing& crossing) const {
  double way_m = 0.0;
  for (const Interval& part : parts) {
    const Eigen::Vector2d in = along_axes(segment.at(part.begin));
    const Eigen::Vector2d out = along_axes(segment.at(part.end));
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      crossing.inner_walls +=
          walls_between(in[axis], out[axis], low_m_[axis], high_m_[axis], room_m_);
    }
    way_m += (out - in).lpNorm<1>();
  }
  crossing.mean_inner_walls = way_m / room_m_;
}

Surface SolidShape::surface(const Eigen::Vector3d& p) const {
  if (prisms_.size() > 1 && contains(p)) {
    if (const auto out = way_out(p)) {
      return *out;
    }
  }
  Surface nearest = prisms_.front().surface(p);
  for (std::size_t i = 1; i < prisms_.size(); ++i) {
    if (const Surface other = prisms_[i].surface(p); other.distance_m < nearest.distance_m) {
      nearest = other;
    }
  }
  return nearest;
}

/// From inside: the nearest point of a face that has not another prism behind it.
std::optional<Surface> SolidShape::way_out(const Eigen::Vector3d& p) const {
  std::optional<Surface> nearest;
  const auto consider = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& normal) {
    const double distance_m = -(p - at).norm();
    if ((!nearest || distance_m > nearest->distance_m) && !contains(at + kSeam_m * normal)) {
      nearest = Surface{.distance_m = distance_m, .p_WS = at, .normal = normal};
    }
  };
  for (const PrismShape& prism : prisms_) {
    for (const PrismShape::Side& side : prism.sides()) {
      const Eigen::Vector2d along = side.to - side.from;
      const double t =
          std::clamp((p.head<2>() - side.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Eigen::Vector2d foot = side.from + t * along;
      const Eigen::Vector2d normal = side.normal();
      consider({foot.x(), foot.y(), std::clamp(p.z(), prism.bottom_m(), prism.top_m())},
               {normal.x(), normal.y(), 0.0});
    }
    if (prism.covers(p.head<2>())) {
      consider({p.x(), p.y(), prism.top_m()}, Eigen::Vector3d::UnitZ());
      consider({p.x(), p.y(), prism.bottom_m()}, -Eigen::Vector3d::UnitZ());
    }
  }
  return nearest;
}

}  // namespace cuscus::city
