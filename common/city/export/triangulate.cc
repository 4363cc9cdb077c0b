#include "common/city/export/triangulate.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace cuscus::city {
namespace {

using Loop = std::vector<std::uint32_t>;  // of corners; bridges are in it twice

/// Twice the area of the triangle, positive when it turns left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool in_triangle(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                 const Eigen::Vector2d& c) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

class EarClipper {
 public:
  explicit EarClipper(const Footprint& footprint) {
    loop_ = append(footprint.outer);
    std::vector<Loop> courtyards;
    for (const Ring& courtyard : footprint.courtyards) {
      courtyards.push_back(append(courtyard));
    }
    // From the east on: a bridge eastwards meets only what has been joined already.
    std::sort(courtyards.begin(), courtyards.end(), [&](const Loop& a, const Loop& b) {
      return corner(*easternmost(a)).x() > corner(*easternmost(b)).x();
    });
    for (Loop& courtyard : courtyards) {
      const auto first = easternmost(courtyard) - courtyard.cbegin();
      std::rotate(courtyard.begin(), courtyard.begin() + first, courtyard.end());
      join(courtyard);
    }
  }

  FlatMesh mesh() {
    while (loop_.size() > 3) {
      clip(next_ear());
    }
    if (loop_.size() == 3) {
      mesh_.triangles.push_back({loop_[0], loop_[1], loop_[2]});
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] const Eigen::Vector2d& corner(std::uint32_t i) const { return mesh_.corners[i]; }
  [[nodiscard]] const Eigen::Vector2d& at(std::size_t k) const {
    return corner(loop_[k % loop_.size()]);
  }

  Loop append(const Ring& ring) {
    Loop loop;
    for (const Eigen::Vector2d& point : ring) {
      loop.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
      mesh_.corners.push_back(point);
    }
    return loop;
  }

  [[nodiscard]] Loop::const_iterator easternmost(const Loop& loop) const {
    return std::max_element(loop.begin(), loop.end(), [&](std::uint32_t a, std::uint32_t b) {
      return corner(a).x() < corner(b).x();
    });
  }

  /// A place in the loop that is seen from `from`, to the east of it. Eberly, section 4.
  [[nodiscard]] std::size_t visible_from(const Eigen::Vector2d& from) const;
  void join(const Loop& courtyard);
  [[nodiscard]] bool is_ear(std::size_t k) const;
  [[nodiscard]] std::size_t next_ear() const;
  void clip(std::size_t k);

  FlatMesh mesh_;
  Loop loop_;
};

std::size_t EarClipper::visible_from(const Eigen::Vector2d& from) const {
  // The side that a ray to the east hits first, and its eastern end.
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t k = 0; k < loop_.size(); ++k) {
    const Eigen::Vector2d& a = at(k);
    const Eigen::Vector2d& b = at(k + 1);
    if (a.y() > from.y() || b.y() < from.y() || a.y() == b.y()) {
      continue;  // the inside of the loop is to the left: only sides that go up are hit
    }
    const double x = a.x() + (b.x() - a.x()) * (from.y() - a.y()) / (b.y() - a.y());
    if (x >= from.x() && x < nearest) {
      nearest = x;
      best = a.x() > b.x() ? k : (k + 1) % loop_.size();
    }
  }
  // Corners that turn inwards may hide it: then the one nearest to the ray's direction is seen.
  const Eigen::Vector2d hit{nearest, from.y()};
  const Eigen::Vector2d end = at(best);
  const bool above = end.y() > from.y();
  const Eigen::Vector2d& p = above ? hit : end;
  const Eigen::Vector2d& q = above ? end : hit;
  double least_slope = std::numeric_limits<double>::infinity();
  double least_distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loop_.size(); ++k) {
    const Eigen::Vector2d& c = at(k);
    const bool reflex = turn(at(k + loop_.size() - 1), c, at(k + 1)) < 0.0;
    if (c == end || !reflex || c.x() < from.x() || !in_triangle(c, from, p, q)) {
      continue;
    }
    const double slope = std::abs(c.y() - from.y()) / (c.x() - from.x());
    const double distance = (c - from).squaredNorm();
    if (slope < least_slope || (slope == least_slope && distance < least_distance)) {
      least_slope = slope;
      least_distance = distance;
      best = k;
    }
  }
  return best;
}

void EarClipper::join(const Loop& courtyard) {
  const std::size_t k = visible_from(corner(courtyard.front()));
  Loop detour = courtyard;
  detour.push_back(courtyard.front());
  detour.push_back(loop_[k]);
  loop_.insert(loop_.begin() + static_cast<std::ptrdiff_t>(k) + 1, detour.begin(), detour.end());
}

bool EarClipper::is_ear(std::size_t k) const {
  const Eigen::Vector2d& a = at(k + loop_.size() - 1);
  const Eigen::Vector2d& b = at(k);
  const Eigen::Vector2d& c = at(k + 1);
  if (turn(a, b, c) <= 0.0) {
    return false;
  }
  return std::none_of(loop_.begin(), loop_.end(), [&](std::uint32_t other) {
    const Eigen::Vector2d& p = corner(other);
    return p != a && p != b && p != c && in_triangle(p, a, b, c);
  });
}

/// Of a loop with no ear left, which only rounding or a bad footprint makes: the flattest corner.
std::size_t EarClipper::next_ear() const {
  std::size_t flattest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loop_.size(); ++k) {
    if (is_ear(k)) {
      return k;
    }
    const double size = std::abs(turn(at(k + loop_.size() - 1), at(k), at(k + 1)));
    if (size < least) {
      least = size;
      flattest = k;
    }
  }
  return flattest;
}

void EarClipper::clip(std::size_t k) {
  const std::size_t before = (k + loop_.size() - 1) % loop_.size();
  const std::size_t after = (k + 1) % loop_.size();
  mesh_.triangles.push_back({loop_[before], loop_[k], loop_[after]});
  loop_.erase(loop_.begin() + static_cast<std::ptrdiff_t>(k));
}

}  // namespace

FlatMesh triangulated(const Footprint& footprint) { return EarClipper{footprint}.mesh(); }

}  // namespace cuscus::city
