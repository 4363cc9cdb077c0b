#include "netsim/channel/box_obstacles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace cuscus::netsim {
namespace {

void require_box(bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"obstacle: " + rule};
  }
}

/// Walls of a grid, which begins at the outer wall -half, between two coordinates within the box.
std::uint32_t grid_walls(double from_m, double to_m, double half_m, double spacing_m) {
  const double walls = std::max(0.0, std::ceil(2.0 * half_m / spacing_m) - 1.0);
  const auto room = [&](double x_m) {
    return std::clamp(std::floor((x_m + half_m) / spacing_m), 0.0, walls);
  };
  return static_cast<std::uint32_t>(std::abs(room(to_m) - room(from_m)));
}

void widen(Turn& turn, double at_a, double at_b) {
  turn.at_a = std::max(turn.at_a, at_a);
  turn.at_b = std::max(turn.at_b, at_b);
}

/// tan(θ/2) of a vector with these components along and, at least 0, across; of one in line: 0.
double half_angle_tangent(double along_m, double across_m) {
  return across_m == 0.0 ? 0.0 : across_m / (std::hypot(along_m, across_m) + along_m);
}

/// Over the roof: by its edges above the two points where the line goes over the rectangle's rim.
Turn turn_over(const UprightBox& box, const Eigen::Vector3d& p_OA, const Eigen::Vector3d& p_OB) {
  const Eigen::Vector3d way_m = p_OB - p_OA;
  const double level_m = std::hypot(way_m.x(), way_m.y());
  const auto rim = box.over_rectangle(p_OA, p_OB);
  if (level_m == 0.0 || !rim) {
    return {};
  }
  const double length_m = way_m.norm();
  Turn turn{.at_a = 0.0, .at_b = 0.0};
  for (const double t : {rim->begin, rim->end}) {
    const double above_m = box.height_m() - (p_OA.z() + t * way_m.z());
    if (above_m <= 0.0) {
      continue;
    }
    const double across_m = above_m * level_m / length_m;
    const double along_m = above_m * way_m.z() / length_m;
    widen(turn, half_angle_tangent(t * length_m + along_m, across_m),
          half_angle_tangent((1.0 - t) * length_m - along_m, across_m));
  }
  return turn;
}

/// Around the sides: by the corners of that part of the rectangle over which the line is below the
/// roof. (Over the rest of it the box is in nobody's way, and may be all around an end.)
void turn_around(const UprightBox& box, const Eigen::Vector3d& p_OA, const Eigen::Vector3d& p_OB,
                 Turn& left, Turn& right) {
  const Eigen::Vector2d level_m = (p_OB - p_OA).head<2>();
  const double length_m = level_m.norm();
  if (length_m == 0.0) {
    return;
  }
  const Eigen::Vector2d along = level_m / length_m;
  const double rise_m = p_OB.z() - p_OA.z();
  // Where the line goes through the height of the roof, along it; which side of that is below.
  const double roof_m = length_m * (box.height_m() - p_OA.z()) / rise_m;
  const auto below_roof = [&](double x_m) {
    return rise_m == 0.0 || (rise_m > 0.0 ? x_m <= roof_m : x_m >= roof_m);
  };
  left = right = {.at_a = 0.0, .at_b = 0.0};
  const auto add = [&](double x_m, double y_m) {
    widen(y_m > 0.0 ? left : right, half_angle_tangent(x_m, std::abs(y_m)),
          half_angle_tangent(length_m - x_m, std::abs(y_m)));
  };
  const auto in_line = [&](double x_m, double y_m) {
    const Eigen::Vector2d p_m = Eigen::Vector2d{x_m, y_m} - p_OA.head<2>();
    return Eigen::Vector2d{p_m.dot(along), along.x() * p_m.y() - along.y() * p_m.x()};
  };
  const Eigen::Vector2d& half_m = box.half_m();
  const std::array<Eigen::Vector2d, 4> corners{
      in_line(half_m.x(), half_m.y()), in_line(-half_m.x(), half_m.y()),
      in_line(-half_m.x(), -half_m.y()), in_line(half_m.x(), -half_m.y())};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& here = corners[i];
    const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
    if (below_roof(here.x())) {
      add(here.x(), here.y());
    }
    if (below_roof(here.x()) != below_roof(next.x())) {
      add(roof_m, std::lerp(here.y(), next.y(), (roof_m - here.x()) / (next.x() - here.x())));
    }
  }
}

/// Obstruction::clearance_m of a box that the segment does not cross. D²/(t (1 - t)) has one
/// minimum, as D is convex and √(t (1 - t)) concave in t: found by golden sections.
double clearance(const UprightBox& box, const Eigen::Vector3d& p_OA, const Eigen::Vector3d& p_OB) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSections = 48;  // to 1e-10 of the length
  const Eigen::Vector3d way_m = p_OB - p_OA;
  const auto at = [&](double t) {
    const double distance_m = box.distance_m(p_OA + t * way_m);
    return distance_m * distance_m / (t * (1.0 - t));
  };
  double begin = 0.0;
  double end = 1.0;
  double low = end - kGolden;
  double high = begin + kGolden;
  double at_low = at(low);
  double at_high = at(high);
  for (int i = 0; i < kSections; ++i) {
    if (at_low < at_high) {
      end = high;
      high = low;
      at_high = at_low;
      low = end - kGolden * (end - begin);
      at_low = at(low);
    } else {
      begin = low;
      low = high;
      at_low = at_high;
      high = begin + kGolden * (end - begin);
      at_high = at(high);
    }
  }
  return std::min(at_low, at_high) / (2.0 * way_m.norm());
}

}  // namespace

BoxObstacles::BoxObstacles(const std::vector<BoxObstacle>& boxes) {
  constexpr double kLargest_m = 1e6;
  constexpr double kLeastSpacing_m = 0.01;
  for (const BoxObstacle& box : boxes) {
    const UprightBox::Parameters& shape = box.shape;
    require_box(shape.centre_m.allFinite() && std::isfinite(shape.heading_rad),
                "its centre and heading must be finite");
    require_box(shape.size_m.minCoeff() > 0.0 && shape.size_m.maxCoeff() <= kLargest_m,
                "length, width and height must be above 0 m and at most 1000 km");
    require_box(box.outer_wall.value >= 0.0 && std::isfinite(box.outer_wall.value) &&
                    box.inner_wall.value >= 0.0 && std::isfinite(box.inner_wall.value),
                "walls must lose at least 0 dB");
    require_box(box.inner_spacing_m == 0.0 ||
                    (box.inner_spacing_m >= kLeastSpacing_m && box.inner_spacing_m <= kLargest_m),
                "the spacing of inner walls must be 1 cm to 1000 km, or 0 m for none");
    bodies_.push_back({.box = UprightBox{shape},
                       .radius_m = 0.5 * shape.size_m.head<2>().norm(),
                       .outer_wall = box.outer_wall,
                       .inner_spacing_m = box.inner_spacing_m,
                       .inner_wall = box.inner_wall});
  }
}

/// Whether the segment comes as near as `margin_m` to the upright cylinder around the box.
bool BoxObstacles::may_matter(const Body& body, const Eigen::Vector3d& p_WA,
                              const Eigen::Vector3d& p_WB, double margin_m) {
  if (std::min(p_WA.z(), p_WB.z()) > body.box.height_m() + margin_m) {
    return false;
  }
  const Eigen::Vector2d way_m = (p_WB - p_WA).head<2>();
  const Eigen::Vector2d centre_m = body.box.centre_m() - p_WA.head<2>();
  const double length2_m2 = way_m.squaredNorm();
  const double t = length2_m2 > 0.0 ? std::clamp(centre_m.dot(way_m) / length2_m2, 0.0, 1.0) : 0.0;
  const double reach_m = body.radius_m + margin_m;
  return (centre_m - t * way_m).squaredNorm() <= reach_m * reach_m;
}

Obstruction BoxObstacles::crossed(const Body& body, const Eigen::Vector3d& p_OA,
                                  const Eigen::Vector3d& p_OB, const Chord& inside) {
  const bool from_inside = body.box.contains(p_OA);
  const bool to_inside = body.box.contains(p_OB);
  Obstruction result{.crossed = true};
  result.walls.outer = 2U - (from_inside ? 1U : 0U) - (to_inside ? 1U : 0U);
  result.outer_loss = {result.walls.outer * body.outer_wall.value};
  if (body.inner_spacing_m > 0.0) {
    const Eigen::Vector3d way_m = p_OB - p_OA;
    const Eigen::Vector3d in_m = p_OA + inside.begin * way_m;
    const Eigen::Vector3d out_m = p_OA + inside.end * way_m;
    const Eigen::Vector2d& half_m = body.box.half_m();
    result.walls.inner = grid_walls(in_m.x(), out_m.x(), half_m.x(), body.inner_spacing_m) +
                         grid_walls(in_m.y(), out_m.y(), half_m.y(), body.inner_spacing_m);
    const double mean_walls = (out_m - in_m).head<2>().lpNorm<1>() / body.inner_spacing_m;
    result.inner_loss = {mean_walls * body.inner_wall.value};
  }
  if (!from_inside && !to_inside) {
    auto& turns = result.turns;
    turns[static_cast<std::size_t>(Way::kOver)] = turn_over(body.box, p_OA, p_OB);
    turn_around(body.box, p_OA, p_OB, turns[static_cast<std::size_t>(Way::kLeft)],
                turns[static_cast<std::size_t>(Way::kRight)]);
  }
  return result;
}

void BoxObstacles::look_at(const Body& body, const Eigen::Vector3d& p_WA,
                           const Eigen::Vector3d& p_WB, double zone_m,
                           std::vector<Obstruction>& found) {
  if (!may_matter(body, p_WA, p_WB, margin_m(p_WA, p_WB, zone_m, 0.0))) {
    return;
  }
  const Eigen::Vector3d p_OA = body.box.in_box(p_WA);
  const Eigen::Vector3d p_OB = body.box.in_box(p_WB);
  if (const auto inside = body.box.crossing(p_OA, p_OB)) {
    found.push_back(crossed(body, p_OA, p_OB, *inside));
  } else if (const double clearance_m = clearance(body.box, p_OA, p_OB); clearance_m < zone_m) {
    found.push_back({.clearance_m = clearance_m});
  }
}

void BoxObstacles::find(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double zone_m,
                        std::vector<Obstruction>& found) const {
  if (!((p_WB - p_WA).norm() > 0.0)) {
    return;
  }
  for (const Body& body : bodies_) {
    look_at(body, p_WA, p_WB, zone_m, found);
  }
}

void BoxObstacles::look_around(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                               double zone_m, double slack_m, Nearby& nearby) const {
  const double reach_m = margin_m(p_WA, p_WB, zone_m, slack_m) + slack_m;
  nearby.bodies.clear();
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    if (may_matter(bodies_[body], p_WA, p_WB, reach_m)) {
      nearby.bodies.push_back(body);
    }
  }
}

void BoxObstacles::find(const Nearby& nearby, const Eigen::Vector3d& p_WA,
                        const Eigen::Vector3d& p_WB, double zone_m,
                        std::vector<Obstruction>& found) const {
  if (!((p_WB - p_WA).norm() > 0.0)) {
    return;
  }
  for (const std::uint32_t body : nearby.bodies) {
    look_at(bodies_[body], p_WA, p_WB, zone_m, found);
  }
}

}  // namespace cuscus::netsim
