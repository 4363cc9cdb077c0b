#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/city/import/import_report.h"

/// What the importer takes from OpenStreetMap's files, before anything is interpreted.
namespace cuscus::city {

/// Degrees of WGS-84.
struct GeoPoint {
  double longitude_deg{0.0};
  double latitude_deg{0.0};
};

/// From west to east and from south to north; never across the 180th meridian.
struct GeoBox {
  double west_deg{0.0};
  double south_deg{0.0};
  double east_deg{0.0};
  double north_deg{0.0};

  [[nodiscard]] bool contains(const GeoPoint& p) const {
    return p.longitude_deg >= west_deg && p.longitude_deg <= east_deg &&
           p.latitude_deg >= south_deg && p.latitude_deg <= north_deg;
  }
  [[nodiscard]] bool meets(const GeoBox& other) const {
    return west_deg <= other.east_deg && east_deg >= other.west_deg &&
           south_deg <= other.north_deg && north_deg >= other.south_deg;
  }
  void extend(const GeoBox& other) {
    west_deg = std::min(west_deg, other.west_deg);
    south_deg = std::min(south_deg, other.south_deg);
    east_deg = std::max(east_deg, other.east_deg);
    north_deg = std::max(north_deg, other.north_deg);
  }
};

/// The first and last corner differ.
using GeoRing = std::vector<GeoPoint>;

struct GeoPolygon {
  GeoRing outer;
  std::vector<GeoRing> courtyards;
};

/// Of an object's tags those that the importer knows.
class Tags {
 public:
  void add(std::string_view key, std::string_view value) { tags_.emplace_back(key, value); }

  /// Empty: there is none.
  [[nodiscard]] std::string_view operator[](std::string_view key) const {
    const auto found = std::ranges::find(tags_, key, &std::pair<std::string, std::string>::first);
    return found != tags_.end() ? std::string_view{found->second} : std::string_view{};
  }

 private:
  std::vector<std::pair<std::string, std::string>> tags_;
};

enum class AreaKind : std::uint8_t { kBuilding, kPart, kWood };

struct AreaRecord {
  ObjectId object{};
  AreaKind kind{AreaKind::kBuilding};
  std::vector<GeoPolygon> polygons{};
  Tags tags{};
  std::size_t file{0};  ///< Index in ImportReport::files.
};

struct StreetRecord {
  ObjectId object{};
  std::vector<GeoPoint> points{};
  Tags tags{};
  std::size_t file{0};
};

struct TreeRecord {
  ObjectId object{};
  GeoPoint point{};
  Tags tags{};
  std::size_t file{0};
};

struct OsmRecords {
  std::vector<AreaRecord> areas;
  std::vector<StreetRecord> streets;
  std::vector<TreeRecord> trees;
  std::optional<GeoBox> extent;  ///< Of all nodes of the files.
};

}  // namespace cuscus::city
