#include "common/city/geometry/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/city/geometry/capsule.h"
#include "common/city/geometry/solid_shape.h"

namespace cuscus::city {

void keep_first(std::optional<Touch>& first, const Touch& other, const Eigen::Vector3d& way) {
  if (!first || other.t < first->t ||
      (other.t == first->t && other.normal.dot(way) < first->normal.dot(way))) {
    first = other;
  }
}

std::optional<Touch> sweep_capsule(const Capsule& capsule, const Eigen::Vector3d& p,
                                   const Eigen::Vector3d& way) {
  const auto part = capsule.inside(p, way);
  if (!part || part->begin > 1.0 || part->end <= 0.0) {
    return std::nullopt;
  }
  const double t = std::max(0.0, part->begin);
  const Eigen::Vector3d normal = capsule.normal(p + t * way);
  // From inside it goes deeper up to the middle of its way through.
  if (normal.dot(way) >= 0.0) {
    return std::nullopt;
  }
  return Touch{.t = t, .normal = normal};
}

namespace {

/// A ball on its way past one prism, from outside.
class PrismSweep {
 public:
  PrismSweep(const PrismShape& prism, const Eigen::Vector3d& p, const Eigen::Vector3d& way,
             double radius_m)
      : prism_{prism}, p_{p}, way_{way}, radius_m_{radius_m} {}

  /// All within the radius of a prism is above its roof, before a wall, or around an edge: the
  /// first of these to be entered.
  void touch(std::optional<Touch>& first) {
    touch_flat(prism_.top_m(), 1.0, first);
    touch_flat(prism_.bottom_m(), -1.0, first);
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m_);
    const Eigen::Vector2d end = (p_ + way_).head<2>();
    const Eigen::Vector2d low = p_.head<2>().cwiseMin(end) - reach;
    const Eigen::Vector2d high = p_.head<2>().cwiseMax(end) + reach;
    for (std::size_t i = 0; i < prism_.sides().size(); ++i) {
      const PrismShape::Side& side = prism_.sides()[i];
      if ((side.from.cwiseMin(side.to).array() <= high.array()).all() &&
          (side.from.cwiseMax(side.to).array() >= low.array()).all()) {
        touch_wall(side, first);
        touch_edges(i, first);
      }
    }
  }

 private:
  void touch_flat(double z_m, double out, std::optional<Touch>& first) const {
    const double above_m = out * (p_.z() - z_m);
    const double sinking_m = -out * way_.z();
    if (above_m < 0.0 || sinking_m <= 0.0) {
      return;
    }
    const double t = std::max(0.0, (above_m - radius_m_) / sinking_m);
    if (t <= 1.0 && prism_.covers((p_ + t * way_).head<2>())) {
      keep_first(first, {.t = t, .normal = {0.0, 0.0, out}}, way_);
    }
  }

  void touch_wall(const PrismShape::Side& side, std::optional<Touch>& first) const {
    const Eigen::Vector2d normal = side.normal();
    const double before_m = (p_.head<2>() - side.from).dot(normal);
    const double nearing_m = -way_.head<2>().dot(normal);
    if (before_m < 0.0 || nearing_m <= 0.0) {
      return;
    }
    const double t = std::max(0.0, (before_m - radius_m_) / nearing_m);
    if (t > 1.0) {
      return;
    }
    const Eigen::Vector3d at = p_ + t * way_;
    const Eigen::Vector2d along = side.to - side.from;
    const double place = (at.head<2>() - side.from).dot(along);
    if (place >= 0.0 && place <= along.squaredNorm() && at.z() >= prism_.bottom_m() &&
        at.z() <= prism_.top_m()) {
      keep_first(first, {.t = t, .normal = {normal.x(), normal.y(), 0.0}}, way_);
    }
  }

  void touch_edges(std::size_t i, std::optional<Touch>& first) const {
    const auto corner = [](const Eigen::Vector2d& p, double z_m) {
      return Eigen::Vector3d{p.x(), p.y(), z_m};
    };
    const PrismShape::Side& side = prism_.sides()[i];
    const double low_m = prism_.bottom_m();
    const double high_m = prism_.top_m();
    const std::array<Capsule, 3> edges{
        Capsule{corner(side.from, low_m), corner(side.from, high_m), radius_m_},
        Capsule{corner(side.from, high_m), corner(side.to, high_m), radius_m_},
        Capsule{corner(side.from, low_m), corner(side.to, low_m), radius_m_}};
    for (const Capsule& edge : edges) {
      const auto touch = sweep_capsule(edge, p_, way_);
      if (touch && !in_a_face_already(i, p_ + touch->t * way_)) {
        keep_first(first, *touch, way_);
      }
    }
  }

  /// Whether a ball there is in a face at this side more than at its edges: it has been from the
  /// start, and slides along that face.
  [[nodiscard]] bool in_a_face_already(std::size_t i, const Eigen::Vector3d& p) const {
    const double nearer_m = radius_m_ * (1.0 - 1e-9);
    const auto before_wall_m = [&](const PrismShape::Side& side) {
      const Eigen::Vector2d along = side.to - side.from;
      const double t =
          std::clamp((p.head<2>() - side.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double apart_m = p.z() - std::clamp(p.z(), prism_.bottom_m(), prism_.top_m());
      return std::hypot((p.head<2>() - side.from - t * along).norm(), apart_m);
    };
    const std::vector<PrismShape::Side>& sides = prism_.sides();
    const bool in_wall =
        before_wall_m(sides[i]) < nearer_m ||
        std::any_of(sides.begin(), sides.end(), [&](const PrismShape::Side& other) {
          return (other.to == sides[i].from || other.from == sides[i].to) &&
                 before_wall_m(other) < nearer_m;
        });
    const double flat_m = std::max(p.z() - prism_.top_m(), prism_.bottom_m() - p.z());
    return in_wall || (flat_m < nearer_m && prism_.covers(p.head<2>()));
  }

  const PrismShape& prism_;
  const Eigen::Vector3d& p_;
  const Eigen::Vector3d& way_;
  double radius_m_;
};

}  // namespace

std::optional<Touch> SolidShape::sweep(const Eigen::Vector3d& p, const Eigen::Vector3d& way,
                                       double radius_m) const {
  if (contains(p)) {
    const Surface out = surface(p);
    return way.dot(out.normal) < 0.0 ? std::optional{Touch{.t = 0.0, .normal = out.normal}}
                                     : std::nullopt;
  }
  std::optional<Touch> first;
  for (const PrismShape& prism : prisms_) {
    PrismSweep{prism, p, way, radius_m}.touch(first);
  }
  return first;
}

}  // namespace cuscus::city
