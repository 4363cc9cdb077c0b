#include "common/city/geometry/city_geometry.h"

#include <algorithm>
#include <tuple>

#include "common/city/geometry/parts.h"
#include "common/city/geometry/refuse.h"
#include "common/city/geometry/sweep.h"

namespace cuscus::city {
namespace {

constexpr double kEndless_m = std::numeric_limits<double>::infinity();
/// Further away there is nothing: cities end at 1000 km.
constexpr double kFarthest_m = 3e6;

using Places = boost::container::small_vector<std::uint32_t, 64>;

template <class Found>
void label(Found& found, Body body, std::uint32_t index) {
  found.body = body;
  found.index = index;
}

Surface surface_of(const Capsule& capsule, const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = capsule.normal(p);
  return {.distance_m = capsule.distance_m(p),
          .p_WS = capsule.on_axis(p) + capsule.radius_m * normal,
          .normal = normal};
}

double distance_m(const std::optional<Hit>& hit) {
  if (hit) {
    return hit->distance_m;
  }
  return kEndless_m;
}

/// What a ray has met so far.
class NearestEntry {
 public:
  NearestEntry(const Eigen::Vector3d& start, const Eigen::Vector3d& way)
      : start_{start}, way_{way} {}

  [[nodiscard]] double limit() const { return found_ ? t_ : 1.0; }
  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] Hit hit(double length_m) const {
    Hit hit = hit_;
    hit.distance_m = t_ * length_m;
    return hit;
  }

  void add(double t, const Eigen::Vector3d& normal, Body body, std::uint32_t index) {
    if (found_ && std::tuple{t, body, index} >= std::tuple{t_, hit_.body, hit_.index}) {
      return;
    }
    found_ = true;
    t_ = t;
    hit_ = {.distance_m = 0.0, .normal = normal, .body = body, .index = index};
  }

  void add(const SolidShape& solid, Body body, std::uint32_t index) {
    for (const PrismShape& prism : solid.prisms()) {
      add(prism, body, index);
    }
  }

  void add(const PrismShape& prism, Body body, std::uint32_t index) {
    if (const auto entry = prism.entry(start_, start_ + way_)) {
      add(entry->t, entry->normal, body, index);
    }
  }

  void add(const Capsule& capsule, std::uint32_t tree) {
    const auto inside = capsule.inside(start_, way_);
    if (!inside || inside->end <= 0.0 || inside->begin > 1.0) {
      return;
    }
    const double t = std::max(0.0, inside->begin);
    add(t, inside->begin < 0.0 ? -way_.normalized() : capsule.normal(start_ + t * way_),
        Body::kTree, tree);
  }

 private:
  Eigen::Vector3d start_;
  Eigen::Vector3d way_;
  bool found_{false};
  double t_{1.0};
  Hit hit_{};
};

}  // namespace

CityGeometry::CityGeometry(const City& city) : parts_{std::make_unique<const Parts>(city)} {}
CityGeometry::CityGeometry(CityGeometry&&) noexcept = default;
CityGeometry& CityGeometry::operator=(CityGeometry&&) noexcept = default;
CityGeometry::~CityGeometry() = default;

std::optional<Hit> CityGeometry::first_hit(const Eigen::Vector3d& p_WO,
                                           const Eigen::Vector3d& direction, double range_m) const {
  require_finite(p_WO, direction);
  require_reach(range_m);
  const double norm = direction.norm();
  if (!(norm > 0.0)) {
    throw std::invalid_argument{"city geometry: a direction must have a length above 0"};
  }
  const double length_m = std::min(range_m, kFarthest_m);
  const Eigen::Vector3d way = length_m / norm * direction;
  NearestEntry nearest{p_WO, way};
  if (const auto t = parts_->ground.hit(p_WO, p_WO + way)) {
    const Eigen::Vector2d foot = (p_WO + *t * way).head<2>();
    const bool buried = p_WO.z() < parts_->ground.height_m(p_WO.head<2>());
    nearest.add(*t, buried ? -direction / norm : parts_->ground.normal(foot), Body::kGround, 0);
  }
  parts_->prisms.first_along(p_WO, way, [&](std::uint32_t place) {
    nearest.add(*parts_->places[place].prism, Body::kBuilding, parts_->places[place].building);
    return nearest.limit();
  });
  parts_->plants.first_along(p_WO, way, [&](std::uint32_t plant) {
    if (plant < parts_->trees.size()) {
      nearest.add(parts_->trees[plant].crown, plant);
      nearest.add(parts_->trees[plant].trunk, plant);
    } else {
      const auto wood = static_cast<std::uint32_t>(plant - parts_->trees.size());
      nearest.add(parts_->woods[wood], Body::kWood, wood);
    }
    return nearest.limit();
  });
  return nearest.found() ? std::optional{nearest.hit(length_m)} : std::nullopt;
}

void CityGeometry::ranges(const Eigen::Vector3d& p_WO, std::span<const Eigen::Vector3d> directions,
                          double range_m, std::span<double> distances_m) const {
  if (directions.size() != distances_m.size()) {
    throw std::invalid_argument{"city geometry: as many distances as directions must fit"};
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto hit = first_hit(p_WO, directions[i], range_m);
    distances_m[i] = distance_m(hit);
  }
}

std::optional<Surface> CityGeometry::nearest(const Eigen::Vector3d& p_W, double radius_m) const {
  std::vector<Surface> all;
  surfaces(p_W, radius_m, all);
  const auto nearest = std::min_element(
      all.begin(), all.end(),
      [](const Surface& x, const Surface& y) { return x.distance_m < y.distance_m; });
  return nearest != all.end() ? std::optional{*nearest} : std::nullopt;
}

void CityGeometry::surfaces(const Eigen::Vector3d& p_W, double radius_m,
                            std::vector<Surface>& surfaces) const {
  require_finite(p_W);
  require_reach(radius_m);
  surfaces.clear();
  const auto keep = [&](Surface surface, Body body, std::uint32_t index) {
    if (surface.distance_m <= radius_m) {
      label(surface, body, index);
      surfaces.push_back(surface);
    }
  };
  parts_->prisms.around(p_W, radius_m, [&](std::uint32_t place) {
    const std::uint32_t building = parts_->places[place].building;
    const auto known = std::find_if(surfaces.begin(), surfaces.end(), [&](const Surface& surface) {
      return surface.index == building;
    });
    if (known == surfaces.end()) {
      keep(parts_->buildings[building].surface(p_W), Body::kBuilding, building);
    }
  });
  parts_->plants.around(p_W, radius_m, [&](std::uint32_t plant) {
    if (plant >= parts_->trees.size()) {
      const auto wood = static_cast<std::uint32_t>(plant - parts_->trees.size());
      keep(parts_->woods[wood].surface(p_W), Body::kWood, wood);
      return;
    }
    const Surface crown = surface_of(parts_->trees[plant].crown, p_W);
    const Surface trunk = surface_of(parts_->trees[plant].trunk, p_W);
    keep(trunk.distance_m < crown.distance_m ? trunk : crown, Body::kTree, plant);
  });
  const Eigen::Vector3d up = parts_->ground.normal(p_W.head<2>());
  const double above_m = parts_->ground.distance_m(p_W);
  keep({.distance_m = above_m, .p_WS = p_W - above_m * up, .normal = up}, Body::kGround, 0);
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface& x, const Surface& y) {
    return std::tuple{x.body, x.index} < std::tuple{y.body, y.index};
  });
}

std::optional<Contact> CityGeometry::sweep(const Eigen::Vector3d& p_WP, const Eigen::Vector3d& p_WQ,
                                           double radius_m) const {
  require_finite(p_WP, p_WQ);
  require_reach(radius_m);
  const Eigen::Vector3d way = p_WQ - p_WP;
  if (way.squaredNorm() == 0.0) {
    return std::nullopt;
  }
  std::optional<Contact> first;
  const auto keep = [&](const std::optional<Touch>& touch, Body body, std::uint32_t index) {
    if (!touch) {
      return;
    }
    const auto rank = [&way](const auto& x, Body of, std::uint32_t number) {
      return std::tuple{x.t, x.normal.dot(way), of, number};
    };
    if (!first || rank(*touch, body, index) < rank(*first, first->body, first->index)) {
      first = Contact{.t = touch->t, .normal = touch->normal, .body = body, .index = index};
    }
  };
  if (const auto t = parts_->ground.contact(p_WP, p_WQ, radius_m)) {
    const Eigen::Vector2d foot = (p_WP + *t * way).head<2>();
    keep(Touch{.t = *t, .normal = parts_->ground.normal(foot)}, Body::kGround, 0);
  }
  const Eigen::Vector3d middle = p_WP + 0.5 * way;
  const double reach_m = 0.5 * way.norm() + radius_m;
  Places buildings;
  parts_->prisms.around(middle, reach_m, [&](std::uint32_t place) {
    buildings.push_back(parts_->places[place].building);
  });
  std::sort(buildings.begin(), buildings.end());
  buildings.erase(std::unique(buildings.begin(), buildings.end()), buildings.end());
  for (const std::uint32_t building : buildings) {
    keep(parts_->buildings[building].sweep(p_WP, way, radius_m), Body::kBuilding, building);
  }
  parts_->plants.around(middle, reach_m, [&](std::uint32_t plant) {
    if (plant >= parts_->trees.size()) {
      const auto wood = static_cast<std::uint32_t>(plant - parts_->trees.size());
      keep(parts_->woods[wood].sweep(p_WP, way, radius_m), Body::kWood, wood);
      return;
    }
    for (Capsule part : {parts_->trees[plant].crown, parts_->trees[plant].trunk}) {
      part.radius_m += radius_m;
      keep(sweep_capsule(part, p_WP, way), Body::kTree, plant);
    }
  });
  return first;
}

std::optional<std::uint32_t> CityGeometry::inside(const Eigen::Vector3d& p_W) const {
  require_finite(p_W);
  std::optional<std::uint32_t> found;
  parts_->prisms.around(p_W, 0.0, [&](std::uint32_t place) {
    const std::uint32_t building = parts_->places[place].building;
    if ((!found || building < *found) && parts_->places[place].prism->contains(p_W)) {
      found = building;
    }
  });
  return found;
}

double CityGeometry::ground_m(const Eigen::Vector2d& p_W) const {
  require_finite(p_W);
  return parts_->ground.height_m(p_W);
}

double CityGeometry::free_above_m(const Eigen::Vector3d& p_W) const {
  const auto hit = first_hit(p_W, Eigen::Vector3d::UnitZ(), kEndless_m);
  return distance_m(hit);
}

double CityGeometry::free_below_m(const Eigen::Vector3d& p_W) const {
  const auto hit = first_hit(p_W, -Eigen::Vector3d::UnitZ(), kEndless_m);
  return distance_m(hit);
}

}  // namespace cuscus::city
