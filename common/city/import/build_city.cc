#include "common/city/import/build_city.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "common/city/import/city_parts.h"
#include "common/city/import/footprints.h"
#include "common/city/import/read_terrain.h"

namespace cuscus::city {
namespace {

/// Sorts by kind and id, and drops the second of two, as when files overlap.
template <typename Record, typename Key>
void sort_once(std::vector<Record>& records, ImportReport& report, const Key& key) {
  std::ranges::stable_sort(records, {}, key);
  const auto again = [&](const Record& kept, const Record& next) {
    const bool same = key(kept) == key(next);
    if (same) {
      report.files[next.file].add(Problem::kDuplicate, next.object);
    }
    return same;
  };
  records.erase(std::unique(records.begin(), records.end(), again), records.end());
}

void sort_records(OsmRecords& records, ImportReport& report) {
  sort_once(records.areas, report, [](const AreaRecord& area) {
    return std::tuple{area.kind, area.object.type, area.object.id};
  });
  sort_once(records.trees, report, [](const TreeRecord& tree) { return tree.object.id; });
  // A street may be in pieces.
  sort_once(records.streets, report, [](const StreetRecord& street) {
    return std::tuple{street.object.id, street.points.front().longitude_deg,
                      street.points.front().latitude_deg};
  });
}

/// Of those above the ground: stations and garages under it may reach far beyond.
std::optional<GeoBox> box_of_buildings(const std::vector<AreaRecord>& areas) {
  std::optional<GeoBox> box;
  for (const AreaRecord& area : areas) {
    if (area.kind == AreaKind::kWood || is_under_ground(area)) {
      continue;
    }
    for (const GeoPolygon& polygon : area.polygons) {
      for (const GeoPoint& p : polygon.outer) {
        const GeoBox point{p.longitude_deg, p.latitude_deg, p.longitude_deg, p.latitude_deg};
        box = box.value_or(point);
        box->extend(point);
      }
    }
  }
  return box;
}

std::string box_text(const GeoBox& box) {
  char text[100];
  std::snprintf(text, sizeof(text), "%.4f,%.4f,%.4f,%.4f", box.west_deg, box.south_deg,
                box.east_deg, box.north_deg);
  return text;
}

constexpr const char* kNothingStands = "no building of those mapped stands above the ground";

[[noreturn]] void refuse(const ImportReport& report, const std::string& cause) {
  std::string files;
  for (const FileReport& file : report.files) {
    files += (files.empty() ? "" : ", ") + file.file;
  }
  throw CityFileError{files + ": " + cause};
}

/// Larger than 100 km either way. There the plane is no picture of the earth's surface any more:
/// 50 km from the origin it is 196 m above it.
bool is_larger_than_a_city(const GeoBox& box) {
  constexpr double kLargest_m = 100'000.0;
  constexpr double kDegree_m = 111'200.0;  // of latitude
  const double middle_rad = (box.south_deg + box.north_deg) / 2.0 * std::numbers::pi / 180.0;
  return (box.north_deg - box.south_deg) * kDegree_m > kLargest_m ||
         (box.east_deg - box.west_deg) * kDegree_m * std::cos(middle_rad) > kLargest_m;
}

/// The box in the frame: its four corners' bounds.
Eigen::AlignedBox2d local_box(const GeoBox& box, const Site& site) {
  Eigen::AlignedBox2d local;
  for (const double longitude_deg : {box.west_deg, box.east_deg}) {
    for (const double latitude_deg : {box.south_deg, box.north_deg}) {
      local.extend(site.place_of({longitude_deg, latitude_deg}));
    }
  }
  return local;
}

Geodetic origin_of(const GeoBox& box) {
  return {.latitude_deg = (box.south_deg + box.north_deg) / 2.0,
          .longitude_deg = (box.west_deg + box.east_deg) / 2.0,
          .height_m = 0.0};
}

/// The city's ground, and what is wrong with it.
Terrain terrain_of(const AsciiGrid& grid, const TerrainFile& file, const LocalFrame& frame,
                   const Eigen::AlignedBox2d& box, ImportReport& report) {
  PlacedTerrain ground = ground_of(grid, file.frame, frame, box);
  if (!ground.covered) {
    report.remarks.push_back(file.file.native() +
                             ": does not cover the city; beyond it the ground is as at its edge");
  }
  if (grid.holes > 0) {
    report.remarks.push_back(file.file.native() + ": " + std::to_string(grid.holes) +
                             " cells have no height; they have the lowest height of all");
  }
  return std::move(ground.terrain);
}

}  // namespace

Eigen::Vector2d Site::place_of(const GeoPoint& point) const {
  return frame
      .to_local({.latitude_deg = point.latitude_deg,
                 .longitude_deg = point.longitude_deg,
                 .height_m = frame.origin().height_m})
      .head<2>();
}

Ring Site::ring_of(const GeoRing& ring) const {
  Ring local;
  local.reserve(ring.size());
  for (const GeoPoint& point : ring) {
    local.push_back(place_of(point));
  }
  return local;
}

double Site::ground_m(const Eigen::Vector2d& place_m) const {
  return terrain ? height_at(*terrain, place_m) : 0.0;
}

std::vector<Footprint> footprints_of(const AreaRecord& area, const Site& site,
                                     ImportReport& report) {
  std::vector<Footprint> footprints;
  for (const GeoPolygon& polygon : area.polygons) {
    Footprint footprint{.outer = site.ring_of(polygon.outer), .courtyards = {}};
    for (const GeoRing& courtyard : polygon.courtyards) {
      footprint.courtyards.push_back(site.ring_of(courtyard));
    }
    if (auto usable = normalized(std::move(footprint))) {
      footprints.push_back(std::move(*usable));
    }
  }
  if (footprints.empty()) {
    report.files[area.file].add(Problem::kNoArea, area.object);
  }
  return footprints;
}

City build_city(OsmRecords records, const ImportOptions& options, ImportReport& report) {
  sort_records(records, report);
  const auto built = box_of_buildings(records.areas);
  if (!built && std::ranges::any_of(records.areas, [](const AreaRecord& area) {
        return area.kind != AreaKind::kWood;
      })) {
    refuse(report, kNothingStands);
  }
  if (!built) {
    const std::string where = options.bounds ? " in " + box_text(*options.bounds) : std::string{};
    refuse(report, "no buildings" + where +
                       (records.extent ? "; the data span " + box_text(*records.extent) : ""));
  }
  const GeoBox whole = options.bounds.value_or(*built);
  if (is_larger_than_a_city(whole)) {
    refuse(report, "spans " + box_text(whole) +
                       ", more than 100 km; allowed: a city, cut out by a bounding box");
  }
  Geodetic origin = options.origin.value_or(origin_of(whole));
  std::optional<AsciiGrid> grid;
  if (options.terrain) {
    grid = read_ascii_grid(options.terrain->file);
    if (!options.origin) {
      origin.height_m = height_at_origin(*grid, options.terrain->frame, origin);
    }
  }
  const LocalFrame frame{origin};
  City city;
  city.origin = frame.origin();
  Site site{.frame = frame, .rule = options.rule, .terrain = city.terrain, .box = {}};
  const Eigen::AlignedBox2d box = local_box(whole, site);
  if (options.bounds) {
    site.box = box;
  }
  if (grid) {
    city.terrain = terrain_of(*grid, *options.terrain, frame, box, report);
  }
  city.buildings = build_buildings(records.areas, site, report);
  city.streets = build_streets(records.streets, site, report);
  city.trees = build_trees(records.trees, site, report);
  city.woods = build_woods(records.areas, site, report);
  if (city.buildings.empty()) {
    refuse(report, kNothingStands);
  }
  Eigen::AlignedBox2d extent = box;
  for (const Building& building : city.buildings) {
    for (const Prism& prism : building.prisms) {
      extent.extend(bounds_of(prism.footprint));
    }
  }
  city.south_west_m = extent.min();
  city.north_east_m = extent.max();
  return city;
}

}  // namespace cuscus::city
