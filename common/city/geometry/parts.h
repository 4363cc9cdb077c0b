#pragma once

#include <cstdint>
#include <vector>

#include "common/city/geometry/box_tree.h"
#include "common/city/geometry/capsule.h"
#include "common/city/geometry/city_geometry.h"
#include "common/city/geometry/ground.h"
#include "common/city/geometry/solid_shape.h"

namespace cuscus::city {

/// Up to here the tree of widened boxes knows what is near a segment.
inline constexpr double kWide_m = 8.0;

/// What a CityGeometry is made of.
struct CityGeometry::Parts {
  explicit Parts(const City& city);

  /// A prism, and the building whose it is.
  struct Place {
    const PrismShape* prism;
    std::uint32_t building;
  };

  /// Where the segment's line is in leaves of a plant.
  void append_leaves(std::uint32_t plant, const Segment& segment, Intervals& leaves) const;

  Ground ground;
  std::vector<SolidShape> buildings;
  std::vector<SolidShape> woods;
  std::vector<TreeShape> trees;
  std::vector<Place> places;     ///< By building, then prism.
  std::vector<Box> boxes;        ///< By place.
  BoxTree prisms;                ///< By place.
  BoxTree wide_prisms;           ///< The same, with kWide_m around each.
  std::vector<Box> plant_boxes;  ///< By plant: all trees, then all woods.
  BoxTree plants;                ///< By plant.
  BoxTree wide_plants;           ///< The same, with kWide_m around each.
};

}  // namespace cuscus::city
