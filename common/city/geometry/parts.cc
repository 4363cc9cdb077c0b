#include "common/city/geometry/parts.h"

#include <algorithm>
#include <utility>

#include "common/city/geometry/check_city.h"

namespace cuscus::city {
namespace {

/// How far what stands on the ground goes on below it.
constexpr double kDepth_m = 1000.0;

const City& checked(const City& city) {
  check_city(city);
  return city;
}

PrismShape standing(const Footprint& footprint, double bottom_m, double top_m,
                    const Ground& ground) {
  const bool stands = std::any_of(
      footprint.outer.begin(), footprint.outer.end(),
      [&](const Eigen::Vector2d& corner) { return bottom_m <= ground.height_m(corner); });
  return {footprint, stands ? std::min(bottom_m, ground.lowest_m()) - kDepth_m : bottom_m, top_m};
}

Box around_both(const Box& a, const Box& b) {
  return {.low_m = a.low_m.cwiseMin(b.low_m), .high_m = a.high_m.cwiseMax(b.high_m)};
}

std::vector<Box> widened(std::vector<Box> boxes) {
  for (Box& box : boxes) {
    box.low_m.array() -= kWide_m;
    box.high_m.array() += kWide_m;
  }
  return boxes;
}

}  // namespace

CityGeometry::Parts::Parts(const City& city)
    : ground{checked(city).terrain}, prisms{{}}, wide_prisms{{}}, plants{{}}, wide_plants{{}} {
  for (const Building& building : city.buildings) {
    std::vector<PrismShape> shapes;
    for (const Prism& prism : building.prisms) {
      shapes.push_back(standing(prism.footprint, prism.bottom_m, prism.top_m, ground));
      boxes.push_back(shapes.back().box());
    }
    buildings.emplace_back(std::move(shapes), building.room_m);
  }
  for (std::uint32_t building = 0; building < buildings.size(); ++building) {
    for (const PrismShape& prism : buildings[building].prisms()) {
      places.push_back({.prism = &prism, .building = building});
    }
  }
  for (const Tree& tree : city.trees) {
    trees.emplace_back(tree);
    plant_boxes.push_back(around_both(trees.back().crown.box(), trees.back().trunk.box()));
  }
  for (const Wood& wood : city.woods) {
    std::vector<PrismShape> shapes{standing(wood.footprint, wood.bottom_m, wood.top_m, ground)};
    plant_boxes.push_back(shapes.front().box());
    woods.emplace_back(std::move(shapes), 0.0);
  }
  prisms = BoxTree{boxes};
  plants = BoxTree{plant_boxes};
  wide_prisms = BoxTree{widened(boxes)};
  wide_plants = BoxTree{widened(plant_boxes)};
}

void CityGeometry::Parts::append_leaves(std::uint32_t plant, const Segment& segment,
                                        Intervals& leaves) const {
  if (plant >= trees.size()) {
    const SolidShape& wood = woods[plant - trees.size()];
    wood.prisms().front().append_inside(segment, leaves);
  } else if (const auto inside = trees[plant].crown.inside(segment.a, segment.b - segment.a)) {
    leaves.push_back(*inside);
  }
}

}  // namespace cuscus::city
