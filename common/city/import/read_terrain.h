#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "common/city/city.h"
#include "common/city/import/import_options.h"
#include "common/city/import/local_frame.h"

namespace cuscus::city {

/// An ESRI ASCII grid as it is in the file.
struct AsciiGrid {
  static constexpr std::size_t kMaxCells = 25'000'000;

  std::size_t columns{0};
  std::size_t rows{0};
  double west{0.0};   ///< Of the centres of the first column, in the file's unit.
  double south{0.0};  ///< Of the centres of the last line's cells.
  double cell{1.0};
  std::vector<float> height_m;  ///< Of row r from the south, column c: [r * columns + c].
  std::size_t holes{0};         ///< Cells without a value: they have the lowest value of all.

  /// Bilinear between cells' centres; beyond the edge, as at the edge.
  [[nodiscard]] double at(double x, double y) const;
  [[nodiscard]] bool covers(double x, double y) const;
};

/// @throws CityFileError naming `name`, key or row, and what is allowed.
[[nodiscard]] AsciiGrid read_ascii_grid(std::istream& stream, const std::string& name);
[[nodiscard]] AsciiGrid read_ascii_grid(const std::filesystem::path& file);

/// The grid's height where a city has its origin.
[[nodiscard]] double height_at_origin(const AsciiGrid& grid, TerrainFrame unit,
                                      const Geodetic& origin);

/// A city's ground from a grid: heights over the ground at the frame's origin.
struct PlacedTerrain {
  Terrain terrain;
  bool covered{true};  ///< False: a part of the box lies beyond the grid.
};
[[nodiscard]] PlacedTerrain ground_of(const AsciiGrid& grid, TerrainFrame unit,
                                      const LocalFrame& frame, const Eigen::AlignedBox2d& box);

/// Bilinear, on and beyond the edge as at the edge [m, up].
[[nodiscard]] double height_at(const Terrain& terrain, const Eigen::Vector2d& point_m);

}  // namespace cuscus::city
