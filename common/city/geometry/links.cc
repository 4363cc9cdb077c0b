// What radio asks of a CityGeometry: what is on a segment, or near it.
#include <algorithm>

#include "common/city/geometry/parts.h"
#include "common/city/geometry/refuse.h"

namespace cuscus::city {
namespace {

using Indices = boost::container::small_vector<std::uint32_t, 64>;
using Prisms = boost::container::small_vector<const PrismShape*, 16>;

/// Whether p(t) = start + t way, 0 <= t <= 1, comes as near to a box on every axis.
bool passes_by(const Box& box, const Eigen::Vector3d& start, const Eigen::Vector3d& way,
               double margin_m) {
  double begin = 0.0;
  double end = 1.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low = box.low_m[axis] - margin_m - start[axis];
    const double high = box.high_m[axis] + margin_m - start[axis];
    if (way[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) {
        return false;
      }
      continue;
    }
    const double at_low = low / way[axis];
    const double at_high = high / way[axis];
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
  // A hair more, for rounding.
  return begin <= end + 1e-9;
}

/// p(t) = start + t way, 0 <= t <= 1, and how far from it matters.
struct Surroundings {
  Eigen::Vector3d start;
  Eigen::Vector3d way;
  double margin_m;
};

/// The boxes that come as near to a segment, in ascending order; `wide` is `tree` with kWide_m
/// around each.
void boxes_near(const std::vector<Box>& boxes, const BoxTree& tree, const BoxTree& wide,
                const Surroundings& asked, std::vector<std::uint32_t>& found) {
  require_reach(asked.margin_m);
  found.clear();
  const auto consider = [&](std::uint32_t box) {
    if (passes_by(boxes[box], asked.start, asked.way, asked.margin_m)) {
      found.push_back(box);
    }
  };
  if (asked.margin_m <= kWide_m) {
    wide.along(asked.start, asked.way, consider);
  } else {
    tree.around(asked.start + 0.5 * asked.way, 0.5 * asked.way.norm() + asked.margin_m, consider);
  }
  std::sort(found.begin(), found.end());
}

/// The share of a segment that is in leaves.
double share_of(Intervals& leaves) {
  unite(leaves, 0.0);
  cut_to_segment(leaves);
  double share = 0.0;
  for (const Interval& part : leaves) {
    share += part.end - part.begin;
  }
  return share;
}

}  // namespace

void CityGeometry::crossings(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                             Crossings& found) const {
  require_finite(p_WA, p_WB);
  found.buildings.clear();
  found.inside.clear();
  const Segment segment{p_WA, p_WB};
  Indices places;
  parts_->prisms.along(segment.a, segment.b - segment.a, [&](std::uint32_t place) {
    places.push_back(place);
    __builtin_prefetch(parts_->places[place].prism);
  });
  std::sort(places.begin(), places.end());
  // Most of the time goes into waiting for memory: ask for all of it before the first is needed.
  for (const std::uint32_t place : places) {
    parts_->places[place].prism->prefetch();
    __builtin_prefetch(&parts_->buildings[parts_->places[place].building]);
  }
  Prisms prisms;
  for (std::size_t i = 0; i < places.size();) {
    const std::uint32_t building = parts_->places[places[i]].building;
    prisms.clear();
    for (; i < places.size() && parts_->places[places[i]].building == building; ++i) {
      prisms.push_back(parts_->places[places[i]].prism);
    }
    parts_->buildings[building].append_crossing(segment, {prisms.data(), prisms.size()}, building,
                                                found);
  }
}

bool CityGeometry::append_crossing(std::uint32_t building, const Eigen::Vector3d& p_WA,
                                   const Eigen::Vector3d& p_WB, Crossings& found) const {
  require_finite(p_WA, p_WB);
  const SolidShape& shape = parts_->buildings.at(building);
  Prisms prisms;
  for (const PrismShape& prism : shape.prisms()) {
    prisms.push_back(&prism);
  }
  return shape.append_crossing(Segment{p_WA, p_WB}, {prisms.data(), prisms.size()}, building,
                               found);
}

bool CityGeometry::blocked(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  const Segment segment{p_WA, p_WB};
  Intervals inside;
  return parts_->prisms.any_along(segment.a, segment.b - segment.a, [&](std::uint32_t place) {
    inside.clear();
    parts_->places[place].prism->append_inside(segment, inside);
    cut_to_segment(inside);
    return !inside.empty();
  });
}

bool CityGeometry::behind_ground(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  return parts_->ground.hit(p_WA, p_WB).has_value();
}

void CityGeometry::prisms_near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                               double margin_m, std::vector<std::uint32_t>& prisms) const {
  require_finite(p_WA, p_WB);
  boxes_near(parts_->boxes, parts_->prisms, parts_->wide_prisms,
             {.start = p_WA, .way = p_WB - p_WA, .margin_m = margin_m}, prisms);
}

void CityGeometry::plants_near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                               double margin_m, std::vector<std::uint32_t>& plants) const {
  require_finite(p_WA, p_WB);
  boxes_near(parts_->plant_boxes, parts_->plants, parts_->wide_plants,
             {.start = p_WA, .way = p_WB - p_WA, .margin_m = margin_m}, plants);
}

void CityGeometry::near(std::span<const std::uint32_t> prisms, const Eigen::Vector3d& p_WA,
                        const Eigen::Vector3d& p_WB, double margin_m,
                        std::vector<std::uint32_t>& buildings) const {
  require_finite(p_WA, p_WB);
  require_reach(margin_m);
  buildings.clear();
  const Eigen::Vector3d way = p_WB - p_WA;
  for (const std::uint32_t prism : prisms) {
    const std::uint32_t building = parts_->places.at(prism).building;
    if ((buildings.empty() || buildings.back() != building) &&
        passes_by(parts_->boxes[prism], p_WA, way, margin_m)) {
      buildings.push_back(building);
    }
  }
}

void CityGeometry::near(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB, double margin_m,
                        std::vector<std::uint32_t>& buildings) const {
  prisms_near(p_WA, p_WB, margin_m, buildings);
  for (std::uint32_t& place : buildings) {
    place = parts_->places[place].building;
  }
  buildings.erase(std::unique(buildings.begin(), buildings.end()), buildings.end());
}

Turns CityGeometry::turns(std::uint32_t building, const Eigen::Vector3d& p_WA,
                          const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  return parts_->buildings.at(building).turns(p_WA, p_WB);
}

double CityGeometry::clearance_m(std::uint32_t building, const Eigen::Vector3d& p_WA,
                                 const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  return parts_->buildings.at(building).clearance_m(p_WA, p_WB);
}

double CityGeometry::foliage_m(const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  const Segment segment{p_WA, p_WB};
  const Eigen::Vector3d way = segment.b - segment.a;
  Intervals leaves;
  parts_->plants.along(segment.a, way,
                       [&](std::uint32_t plant) { parts_->append_leaves(plant, segment, leaves); });
  return share_of(leaves) * way.norm();
}

double CityGeometry::foliage_m(std::span<const std::uint32_t> plants, const Eigen::Vector3d& p_WA,
                               const Eigen::Vector3d& p_WB) const {
  require_finite(p_WA, p_WB);
  const Segment segment{p_WA, p_WB};
  const Eigen::Vector3d way = segment.b - segment.a;
  Intervals leaves;
  for (const std::uint32_t plant : plants) {
    if (passes_by(parts_->plant_boxes.at(plant), segment.a, way, 0.0)) {
      parts_->append_leaves(plant, segment, leaves);
    }
  }
  return share_of(leaves) * way.norm();
}

}  // namespace cuscus::city
