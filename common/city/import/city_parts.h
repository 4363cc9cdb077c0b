#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/import_report.h"
#include "common/city/import/local_frame.h"
#include "common/city/import/osm_records.h"

/// The steps of build_city(), one per kind of thing.
namespace cuscus::city {

/// What each step needs to know of the whole.
struct Site {
  const LocalFrame& frame;
  const CityRule& rule;
  const std::optional<Terrain>& terrain;
  std::optional<Eigen::AlignedBox2d> box;  ///< Streets and woods are cut at its edge.

  /// East and north of a point: the ground is the plane, and its curvature is left out.
  [[nodiscard]] Eigen::Vector2d place_of(const GeoPoint& point) const;
  [[nodiscard]] Ring ring_of(const GeoRing& ring) const;
  [[nodiscard]] double ground_m(const Eigen::Vector2d& place_m) const;
};

/// Of an area those polygons that enclose something; reports when none does.
[[nodiscard]] std::vector<Footprint> footprints_of(const AreaRecord& area, const Site& site,
                                                   ImportReport& report);

/// By its tags.
[[nodiscard]] bool is_under_ground(const AreaRecord& area);

/// `areas` by rising id: outlines and their parts become buildings.
[[nodiscard]] std::vector<Building> build_buildings(const std::vector<AreaRecord>& areas,
                                                    const Site& site, ImportReport& report);
[[nodiscard]] std::vector<Street> build_streets(const std::vector<StreetRecord>& streets,
                                                const Site& site, ImportReport& report);
[[nodiscard]] std::vector<Tree> build_trees(const std::vector<TreeRecord>& trees, const Site& site,
                                            ImportReport& report);
[[nodiscard]] std::vector<Wood> build_woods(const std::vector<AreaRecord>& areas, const Site& site,
                                            ImportReport& report);

}  // namespace cuscus::city
