#include "common/city/geometry/prism_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "common/city/geometry/orientation.h"

namespace cuscus::city {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLeast = 0x1p-52;  ///< Of a segment: what 1 can be told from.

void append_ring(const Ring& ring, std::vector<PrismShape::Side>& sides) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const PrismShape::Side side{.from = ring[i], .to = ring[(i + 1) % ring.size()]};
    if (side.from != side.to) {
      sides.push_back(side);
    }
  }
}

/// A corner, and how far it is to the left of the line (twice the area of the triangle with it).
struct Corner {
  Eigen::Vector2d p;
  double left;
};

/// Where a line through a and b passes between two corners that are on different sides of it. Both
/// neighbours of a wall get the same bits: its lesser end comes first.
double pass_at(const Segment& segment, Corner u, Corner v) {
  const Eigen::Vector2d a = segment.a.head<2>();
  const Eigen::Vector2d b = segment.b.head<2>();
  if (std::tuple{u.p.x(), u.p.y()} > std::tuple{v.p.x(), v.p.y()}) {
    std::swap(u, v);
  }
  const Eigen::Vector2d way = b - a;
  // On the side itself, whatever the rounding: however slowly the line crosses it.
  const Eigen::Vector2d p = u.p + u.left / (u.left - v.left) * (v.p - u.p);
  const double t = (p - a).dot(way) / way.squaredNorm();
  // Whether an end is before, on or behind the side is decided exactly.
  constexpr double kDoubtful = 1e-9;
  const double ahead = u.left > v.left ? -1.0 : 1.0;
  if (std::abs(t) < kDoubtful) {
    const double to_go = ahead * orientation(u.p, v.p, a);
    return to_go == 0.0 ? 0.0 : std::copysign(std::max(std::abs(t), kLeast), to_go);
  }
  if (std::abs(t - 1.0) < kDoubtful) {
    const double to_go = ahead * orientation(u.p, v.p, b);
    return to_go == 0.0 ? 1.0 : 1.0 + std::copysign(std::max(std::abs(t - 1.0), kLeast), to_go);
  }
  return t;
}

}  // namespace

PrismShape::PrismShape(const Footprint& footprint, double bottom_m, double top_m)
    : bottom_m_{bottom_m}, top_m_{top_m} {
  append_ring(footprint.outer, sides_);
  outer_sides_ = sides_.size();
  for (const Ring& courtyard : footprint.courtyards) {
    append_ring(courtyard, sides_);
    courtyard_ends_.push_back(sides_.size());
  }
}

Box PrismShape::box() const {
  Eigen::Vector2d low = sides_.front().from;
  Eigen::Vector2d high = low;
  for (const Side& side : sides_) {
    low = low.cwiseMin(side.from);
    high = high.cwiseMax(side.from);
  }
  return {.low_m = {low.x(), low.y(), bottom_m_}, .high_m = {high.x(), high.y(), top_m_}};
}

bool PrismShape::within(const Eigen::Vector2d& p, std::size_t sides) const {
  bool inside = false;
  for (std::size_t i = 0; i < sides; ++i) {
    const Side& side = sides_[i];
    const bool from_above = side.from.y() > p.y();
    const bool to_above = side.to.y() > p.y();
    if (from_above != to_above) {
      // A ray to the east meets the side if the point is west of it.
      const double turn = orientation(side.from, side.to, p);
      if (to_above ? turn > 0.0 : turn < 0.0) {
        inside = !inside;
      }
    }
  }
  return inside;
}

void PrismShape::prefetch() const {
  constexpr std::size_t kLine_bytes = 64;
  constexpr std::size_t kLines = 6;  // 12 sides: half of all buildings have fewer
  const auto* begin = reinterpret_cast<const char*>(sides_.data());
  const std::size_t end = std::min(sides_.size() * sizeof(Side), kLines * kLine_bytes);
  for (std::size_t at = 0; at < end; at += kLine_bytes) {
    __builtin_prefetch(begin + at);
  }
}

void PrismShape::append_passes(const Segment& segment, Passes& passes) const {
  const Eigen::Vector2d a = segment.a.head<2>();
  const Eigen::Vector2d b = segment.b.head<2>();
  const auto pass_ring = [&](std::size_t begin, std::size_t end) {
    double from_left = orientation(a, b, sides_[begin].from);
    for (std::size_t i = begin; i < end; ++i) {
      const Side& side = sides_[i];
      const double to_left = orientation(a, b, side.to);
      // Corners on the line are to its right: as if the line lay an infinitesimal to the left.
      if ((from_left > 0.0) != (to_left > 0.0)) {
        passes.push_back(
            {.t = pass_at(segment, {side.from, from_left}, {side.to, to_left}), .side = i});
      }
      from_left = to_left;
    }
  };
  pass_ring(0, outer_sides_);
  std::size_t begin = outer_sides_;
  for (const std::size_t end : courtyard_ends_) {
    pass_ring(begin, end);
    begin = end;
  }
  const auto earlier = [](const Pass& x, const Pass& y) {
    return std::tuple{x.t, x.side} < std::tuple{y.t, y.side};
  };
  if (passes.size() == 2 && earlier(passes[1], passes[0])) {
    std::swap(passes[0], passes[1]);
  } else if (passes.size() > 2) {
    std::sort(passes.begin(), passes.end(), earlier);
  }
}

Interval PrismShape::between_flats(const Segment& segment) const {
  const double rise_m = segment.b.z() - segment.a.z();
  if (rise_m == 0.0) {
    const bool between = segment.a.z() >= bottom_m_ && segment.a.z() < top_m_;
    return between ? Interval{.begin = -kNever, .end = kNever}
                   : Interval{.begin = kNever, .end = -kNever};
  }
  const double at_bottom = (bottom_m_ - segment.a.z()) / rise_m;
  const double at_top = (top_m_ - segment.a.z()) / rise_m;
  return {.begin = std::min(at_bottom, at_top), .end = std::max(at_bottom, at_top)};
}

void PrismShape::append_inside(const Segment& segment, Intervals& parts) const {
  const Interval level = between_flats(segment);
  if (!(level.begin < level.end) || level.end < 0.0 || level.begin > 1.0) {
    return;
  }
  if (segment.upright()) {
    if (covers(segment.a.head<2>())) {
      parts.push_back(level);
    }
    return;
  }
  Passes passes;
  append_passes(segment, passes);
  for (std::size_t i = 0; i + 1 < passes.size(); i += 2) {
    const Interval part{.begin = std::max(passes[i].t, level.begin),
                        .end = std::min(passes[i + 1].t, level.end)};
    if (part.begin < part.end) {
      parts.push_back(part);
    }
  }
}

void PrismShape::append_over(const Segment& segment, Intervals& parts) const {
  Passes passes;
  append_passes(segment, passes);
  for (std::size_t i = 0; i + 1 < passes.size(); i += 2) {
    if (passes[i].t < passes[i + 1].t) {
      parts.push_back({.begin = passes[i].t, .end = passes[i + 1].t});
    }
  }
}

std::optional<Entry> PrismShape::entry(const Eigen::Vector3d& p_WA,
                                       const Eigen::Vector3d& p_WB) const {
  const Segment segment{p_WA, p_WB};
  const Interval level = segment.asked_for(between_flats(segment));
  Passes passes;
  if (!segment.upright()) {
    append_passes(segment, passes);
  } else if (covers(p_WA.head<2>())) {
    passes = {{.t = -kNever, .side = kFlat}, {.t = kNever, .side = kFlat}};
  }
  if (segment.reversed) {
    std::reverse(passes.begin(), passes.end());
    for (Pass& pass : passes) {
      pass.t = 1.0 - pass.t;
    }
  }
  const Eigen::Vector3d up{0.0, 0.0, p_WB.z() < p_WA.z() ? 1.0 : -1.0};
  for (std::size_t i = 0; i + 1 < passes.size(); i += 2) {
    const Pass& in = passes[i];
    const double begin = std::max(in.t, level.begin);
    const double end = std::min(passes[i + 1].t, level.end);
    if (!(begin < end) || !(end > 0.0)) {
      continue;
    }
    if (begin > 1.0) {
      break;
    }
    Entry entry{.t = std::max(begin, 0.0), .normal = up};
    if (begin < 0.0) {
      entry.normal = -(p_WB - p_WA).normalized();
    } else if (in.t >= level.begin) {
      entry.normal << sides_[in.side].normal(), 0.0;
    }
    return entry;
  }
  return std::nullopt;
}

Surface PrismShape::surface(const Eigen::Vector3d& p) const {
  double nearest2_m2 = kNever;
  Eigen::Vector2d foot = p.head<2>();
  Eigen::Vector2d wall_normal{1.0, 0.0};
  for (const Side& side : sides_) {
    const Eigen::Vector2d along = side.to - side.from;
    const double t =
        std::clamp((p.head<2>() - side.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector2d near = side.from + t * along;
    const double distance2_m2 = (p.head<2>() - near).squaredNorm();
    if (distance2_m2 < nearest2_m2) {
      nearest2_m2 = distance2_m2;
      foot = near;
      wall_normal = side.normal();
    }
  }
  const double level_m = std::sqrt(nearest2_m2);
  const double above_m = p.z() - top_m_;
  const double below_m = bottom_m_ - p.z();
  const double flat_m = std::max(above_m, below_m);  // above 0: not between bottom and top
  const double flat_z = above_m >= below_m ? top_m_ : bottom_m_;
  const Eigen::Vector3d flat_normal{0.0, 0.0, above_m >= below_m ? 1.0 : -1.0};
  const bool covered = covers(p.head<2>());
  Surface nearest;
  if (covered && (flat_m >= 0.0 || -flat_m <= level_m)) {
    nearest.distance_m = flat_m;
    nearest.p_WS << p.head<2>(), flat_z;
    nearest.normal = flat_normal;
    return nearest;
  }
  nearest.p_WS << foot, flat_m > 0.0 ? flat_z : p.z();
  const Eigen::Vector3d away = p - nearest.p_WS;
  const double distance_m = away.norm();
  nearest.distance_m = covered ? -distance_m : distance_m;
  if (distance_m > 0.0) {
    nearest.normal = away / nearest.distance_m;
  } else {
    nearest.normal << wall_normal, 0.0;
  }
  return nearest;
}

}  // namespace cuscus::city
