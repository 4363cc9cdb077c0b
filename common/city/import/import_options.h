#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/city/city.h"
#include "common/city/import/osm_records.h"
#include "common/city/import/read_osm.h"

namespace cuscus::city {

struct HeightRange {
  double lowest_m{10.0};
  double highest_m{15.0};
};

/// What the map does not say. The defaults are those of docs/city.md.
struct CityRule {
  /// Of buildings with neither height nor levels: uniform within, drawn by seed and OSM id. The
  /// default is the CUSCUS paper's for Bologna; it has 50 to 150 m for Manhattan.
  HeightRange heights;
  std::uint64_t seed{1};
  double level_m{3.0};  ///< From floor to floor: the usual value of Simple 3D Buildings' renderers.
  Material outer_walls{Material::kConcrete};
  double room_m{0.0};  ///< Mean distance between inner walls; 0: none.
  double tree_height_m{10.0};
  double crown_radius_m{3.0};
  double wood_height_m{15.0};
};

/// How the numbers of a terrain file are meant.
enum class TerrainFrame : std::uint8_t {
  kGeographic,  ///< Corner and cell in degrees of WGS-84.
  kLocal,       ///< In metres east and north of the city's origin.
};

struct TerrainFile {
  std::filesystem::path file;  ///< ESRI ASCII grid, heights in metres.
  TerrainFrame frame{TerrainFrame::kGeographic};
};

struct ImportOptions {
  std::optional<GeoBox> bounds;    ///< None: everything in the files.
  std::optional<Geodetic> origin;  ///< None: the centre of `bounds`, else of the buildings' box.
  CityRule rule;
  std::optional<TerrainFile> terrain;
  ReadLimits limits;
};

}  // namespace cuscus::city
