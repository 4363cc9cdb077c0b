// What diffraction needs of a solid: the ways past it, and how far it stays clear.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/city/geometry/solid_shape.h"

namespace cuscus::city {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

void widen(Turn& turn, double at_a, double at_b) {
  turn.at_a = std::max(turn.at_a, at_a);
  turn.at_b = std::max(turn.at_b, at_b);
}

/// tan(θ/2) of a vector with these components along and, at least 0, across; of one in line: 0.
double half_angle_tangent(double along_m, double across_m) {
  return across_m == 0.0 ? 0.0 : across_m / (std::hypot(along_m, across_m) + along_m);
}

/// A link as seen from above: `along` it from A, and across, positive to the left.
struct Baseline {
  Eigen::Vector3d a;
  Eigen::Vector3d way;
  double level_m;
  double length_m;
  Eigen::Vector2d along;

  [[nodiscard]] Eigen::Vector2d in_line(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d from_a = p - a.head<2>();
    return {from_a.dot(along), along.x() * from_a.y() - along.y() * from_a.x()};
  }
};

/// Over the roof of one prism: by its edges above the points where the line goes over its rim.
void widen_over(const PrismShape& prism, const Baseline& link, const Segment& segment, Turn& turn) {
  Intervals over;
  prism.append_over(segment, over);
  for (Interval rim : over) {
    if (!(rim.end > 0.0 && rim.begin < 1.0)) {
      continue;  // in the back of an end
    }
    rim = segment.asked_for(rim);
    for (const double t : {rim.begin, rim.end}) {
      const double above_m = prism.top_m() - (link.a.z() + t * link.way.z());
      if (above_m > 0.0) {
        const double across_m = above_m * link.level_m / link.length_m;
        const double along_m = above_m * link.way.z() / link.length_m;
        widen(turn, half_angle_tangent(t * link.length_m + along_m, across_m),
              half_angle_tangent((1.0 - t) * link.length_m - along_m, across_m));
      }
    }
  }
}

/// That part of the line, along it [m], at whose height a prism is.
Interval at_height_of(const PrismShape& prism, const Baseline& link) {
  const double rise_m = link.way.z();
  if (rise_m == 0.0) {
    const bool there = link.a.z() >= prism.bottom_m() && link.a.z() < prism.top_m();
    return there ? Interval{.begin = -kUnlimited, .end = kUnlimited}
                 : Interval{.begin = kUnlimited, .end = -kUnlimited};
  }
  const double roof_m = link.level_m * (prism.top_m() - link.a.z()) / rise_m;
  const double bottom_m = link.level_m * (prism.bottom_m() - link.a.z()) / rise_m;
  return {.begin = std::min(roof_m, bottom_m), .end = std::max(roof_m, bottom_m)};
}

/// Around the sides of one prism: by the corners of that part of its outline.
void widen_around(const PrismShape& prism, const Baseline& link, Turn& left, Turn& right) {
  const Interval there = at_height_of(prism, link);
  const auto add = [&](double x_m, double y_m) {
    widen(y_m > 0.0 ? left : right, half_angle_tangent(x_m, std::abs(y_m)),
          half_angle_tangent(link.level_m - x_m, std::abs(y_m)));
  };
  for (std::size_t i = 0; i < prism.outer_sides(); ++i) {
    const Eigen::Vector2d here = link.in_line(prism.sides()[i].from);
    const Eigen::Vector2d next = link.in_line(prism.sides()[i].to);
    if (here.x() >= there.begin && here.x() <= there.end) {
      add(here.x(), here.y());
    }
    for (const double limit_m : {there.begin, there.end}) {
      if ((here.x() < limit_m) != (next.x() < limit_m) && std::isfinite(limit_m)) {
        add(limit_m, std::lerp(here.y(), next.y(), (limit_m - here.x()) / (next.x() - here.x())));
      }
    }
  }
  // Out of a courtyard there is no way around.
  for (const double x_m : {0.0, link.level_m}) {
    const Eigen::Vector2d end = link.a.head<2>() + x_m * link.along;
    if (x_m >= there.begin && x_m < there.end && prism.encloses(end)) {
      left = right = Turn{};
    }
  }
}

/// The least D²/(t (1 - t)) over a segment, D the distance to a prism, face by face, edge by edge,
/// corner by corner. Of a plane, a line or a point it is where t = D(0) / (D(0) + D(1)); of a part
/// of one it is there too, or at the part's rim.
class LeastDetour {
 public:
  LeastDetour(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
      : a_{a}, b_{b}, level_m_{(b - a).head<2>().norm()} {
    if (level_m_ > 0.0) {
      across_ = Eigen::Vector2d{a.y() - b.y(), b.x() - a.x()} / level_m_;
    }
  }

  [[nodiscard]] double least_m2() const { return least_m2_; }

  void pass(const PrismShape& prism) {
    for (const double z_m : {prism.top_m(), prism.bottom_m()}) {
      consider([z_m](const Eigen::Vector3d& p) { return std::abs(p.z() - z_m); },
               [&prism](const Eigen::Vector3d& p) { return prism.covers(p.head<2>()); });
    }
    for (const PrismShape::Side& side : prism.sides()) {
      if (may_matter(side)) {
        pass(prism, side);
      }
    }
  }

 private:
  /// Whether a wall is nearer, from above, to the segment's line than what has been found.
  [[nodiscard]] bool may_matter(const PrismShape::Side& side) const {
    if (level_m_ == 0.0) {
      return true;
    }
    const double from_m = (side.from - a_.head<2>()).dot(across_);
    const double to_m = (side.to - a_.head<2>()).dot(across_);
    const double nearest_m =
        (from_m > 0.0) == (to_m > 0.0) ? std::min(std::abs(from_m), std::abs(to_m)) : 0.0;
    return 4.0 * nearest_m * nearest_m < least_m2_;
  }

  void pass(const PrismShape& prism, const PrismShape::Side& side) {
    const Eigen::Vector2d normal = side.normal();
    const Eigen::Vector2d along = side.to - side.from;
    const double length2_m2 = along.squaredNorm();
    const auto before = [&](const Eigen::Vector3d& p) {
      return (p.head<2>() - side.from).dot(normal);
    };
    const auto beside = [&](const Eigen::Vector3d& p) {
      const double place = (p.head<2>() - side.from).dot(along);
      return place >= 0.0 && place <= length2_m2;
    };
    const auto as_high = [&](const Eigen::Vector3d& p) {
      return p.z() >= prism.bottom_m() && p.z() <= prism.top_m();
    };
    consider([&](const Eigen::Vector3d& p) { return std::abs(before(p)); },
             [&](const Eigen::Vector3d& p) { return beside(p) && as_high(p); });
    consider([&](const Eigen::Vector3d& p) { return (p.head<2>() - side.from).norm(); }, as_high);
    for (const double z_m : {prism.top_m(), prism.bottom_m()}) {
      consider([&](const Eigen::Vector3d& p) { return std::hypot(before(p), p.z() - z_m); },
               beside);
      const Eigen::Vector3d corner{side.from.x(), side.from.y(), z_m};
      consider([&](const Eigen::Vector3d& p) { return (p - corner).norm(); },
               [](const Eigen::Vector3d&) { return true; });
    }
  }

  template <class Distance, class Within>
  void consider(const Distance& distance, const Within& within) {
    const double at_a_m = distance(a_);
    const double at_b_m = distance(b_);
    const double sum_m = at_a_m + at_b_m;
    const double t = sum_m > 0.0 ? at_a_m / sum_m : 0.5;
    const Eigen::Vector3d nearest = a_ + t * (b_ - a_);
    if (!within(nearest)) {
      return;
    }
    const double distance_m = distance(nearest);
    // An end on the surface: its limit there.
    const double detour_m2 = t > 0.0 && t < 1.0 ? distance_m * distance_m / (t * (1.0 - t)) : 0.0;
    least_m2_ = std::min(least_m2_, detour_m2);
  }

  Eigen::Vector3d a_;
  Eigen::Vector3d b_;
  double level_m_;
  Eigen::Vector2d across_{Eigen::Vector2d::Zero()};
  double least_m2_{kUnlimited};
};

}  // namespace

Turns SolidShape::turns(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const Eigen::Vector3d way = b - a;
  const double level_m = way.head<2>().norm();
  if (level_m == 0.0) {
    return {};
  }
  const Baseline link{.a = a,
                      .way = way,
                      .level_m = level_m,
                      .length_m = way.norm(),
                      .along = way.head<2>() / level_m};
  const Segment segment{a, b};
  const Turn none{.at_a = 0.0, .at_b = 0.0};
  Turns turns{.over = none, .left = none, .right = none};
  for (const PrismShape& prism : prisms_) {
    widen_over(prism, link, segment, turns.over);
    widen_around(prism, link, turns.left, turns.right);
  }
  return turns;
}

double SolidShape::clearance_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  LeastDetour detour{a, b};
  Intervals crossed;
  const Segment segment{a, b};
  for (const PrismShape& prism : prisms_) {
    prism.append_inside(segment, crossed);
  }
  cut_to_segment(crossed);
  if (!crossed.empty()) {
    return 0.0;
  }
  for (const PrismShape& prism : prisms_) {
    detour.pass(prism);
  }
  const double least_m2 = detour.least_m2();
  return least_m2 > 0.0 ? least_m2 / (2.0 * (b - a).norm()) : 0.0;
}

}  // namespace cuscus::city
