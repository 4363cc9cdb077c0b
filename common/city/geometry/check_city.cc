#include "common/city/geometry/check_city.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cuscus::city {
namespace {

constexpr double kLargest_m = 1e6;

void require_of(const std::string& body, bool holds, const std::string& rule) {
  if (!holds) {
    throw std::invalid_argument{"city: " + body + ": " + rule};
  }
}

bool usable(double x_m) { return std::abs(x_m) <= kLargest_m; }  // not-a-number is not

double twice_area_m2(const Ring& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d p = ring[i] - ring[0];
    const Eigen::Vector2d q = ring[(i + 1) % ring.size()] - ring[0];
    sum += p.x() * q.y() - p.y() * q.x();
  }
  return sum;
}

void check_ring(const std::string& body, const Ring& ring, double turn) {
  require_of(body, ring.size() >= 3, "its rings must have 3 corners or more");
  require_of(body,
             std::all_of(ring.begin(), ring.end(),
                         [](const auto& p) { return usable(p.x()) && usable(p.y()); }),
             "its corners must be at most 1000 km from the origin");
  require_of(body, turn * twice_area_m2(ring) > 0.0,
             "its outer rings must run counter-clockwise around an area, its courtyards clockwise");
}

void check_prism(const std::string& body, const Footprint& footprint, double bottom_m,
                 double top_m) {
  check_ring(body, footprint.outer, 1.0);
  for (const Ring& courtyard : footprint.courtyards) {
    check_ring(body, courtyard, -1.0);
  }
  require_of(body, usable(bottom_m) && usable(top_m) && bottom_m < top_m,
             "its tops must be above its bottoms, and at most 1000 km high");
}

void check_tree(const std::string& body, const Tree& tree) {
  require_of(body, usable(tree.foot_m.x()) && usable(tree.foot_m.y()) && usable(tree.foot_m.z()),
             "its foot must be at most 1000 km from the origin");
  require_of(body,
             usable(tree.height_m) && usable(tree.crown_radius_m) && tree.height_m > 0.0 &&
                 tree.crown_radius_m > 0.0,
             "its height and the radius of its crown must be above 0 m and at most 1000 km");
}

void check_terrain(const Terrain& terrain) {
  const std::string body = "terrain";
  require_of(body, usable(terrain.south_west_m.x()) && usable(terrain.south_west_m.y()),
             "its corner must be at most 1000 km from the origin");
  require_of(body, usable(terrain.cell_m) && terrain.cell_m > 0.0,
             "its cells must be larger than 0 m, and at most 1000 km");
  require_of(body,
             terrain.rows > 0 && terrain.columns > 0 &&
                 terrain.height_m.size() == terrain.rows * terrain.columns,
             "it must have as many heights as rows times columns, and at least one");
  require_of(body,
             std::all_of(terrain.height_m.begin(), terrain.height_m.end(),
                         [](float height_m) { return usable(static_cast<double>(height_m)); }),
             "its heights must be at most 1000 km");
}

}  // namespace

void check_city(const City& city) {
  for (const Building& building : city.buildings) {
    const std::string body = "building " + std::to_string(building.osm_id);
    require_of(body, !building.prisms.empty(), "it must have a prism");
    require_of(body, usable(building.room_m) && building.room_m >= 0.0,
               "its rooms must be 0 m to 1000 km wide");
    for (const Prism& prism : building.prisms) {
      check_prism(body, prism.footprint, prism.bottom_m, prism.top_m);
    }
  }
  for (std::size_t i = 0; i < city.woods.size(); ++i) {
    const Wood& wood = city.woods[i];
    check_prism("wood " + std::to_string(i), wood.footprint, wood.bottom_m, wood.top_m);
  }
  for (std::size_t i = 0; i < city.trees.size(); ++i) {
    check_tree("tree " + std::to_string(i), city.trees[i]);
  }
  if (city.terrain) {
    check_terrain(*city.terrain);
  }
}

}  // namespace cuscus::city
