#include "common/city/import/read_terrain.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <system_error>

namespace cuscus::city {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& cause) {
  throw CityFileError{name + ": is no ESRI ASCII grid: " + cause};
}

/// Bilinear between points of a grid with unit spacing; `x` and `y` are held within it.
double interpolated(std::span<const float> values, std::size_t columns, std::size_t rows, double x,
                    double y) {
  const auto place = [](double at, std::size_t count) {
    const double held = std::clamp(at, 0.0, static_cast<double>(count - 1));
    const auto cell = std::min(static_cast<std::size_t>(held), count > 1 ? count - 2 : 0);
    return std::pair{cell, held - static_cast<double>(cell)};
  };
  const auto [column, east] = place(x, columns);
  const auto [row, north] = place(y, rows);
  const auto value = [&](std::size_t r, std::size_t c) {
    return static_cast<double>(values[std::min(r, rows - 1) * columns + std::min(c, columns - 1)]);
  };
  const double southern = std::lerp(value(row, column), value(row, column + 1), east);
  const double northern = std::lerp(value(row + 1, column), value(row + 1, column + 1), east);
  return std::lerp(southern, northern, north);
}

/// Keys and values up to the first line that starts with a number.
std::map<std::string, double> read_header(std::istream& stream, const std::string& name) {
  std::map<std::string, double> header;
  constexpr std::size_t kMostKeys = 6;
  while (header.size() < kMostKeys && std::isalpha((stream >> std::ws).peek()) != 0) {
    std::string key;
    double value = 0.0;
    constexpr int kLongestKey = 32;
    stream.width(kLongestKey);
    stream >> key >> value;
    std::ranges::transform(key, key.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!stream || !std::isfinite(value)) {
      fail(name, "\"" + key.substr(0, kLongestKey) + "\" is not followed by a number");
    }
    header[key] = value;
  }
  return header;
}

double required(const std::map<std::string, double>& header, const char* key,
                const std::string& name) {
  const auto found = header.find(key);
  if (found == header.end()) {
    fail(name, std::string{key} +
                   " is missing; a grid begins with ncols, nrows, xllcorner or "
                   "xllcenter, yllcorner or yllcenter, cellsize, NODATA_value");
  }
  return found->second;
}

std::size_t count_of(const std::map<std::string, double>& header, const char* key,
                     const std::string& name) {
  const double value = required(header, key, name);
  if (!(value >= 1.0) || value > static_cast<double>(AsciiGrid::kMaxCells) ||
      value != std::floor(value)) {
    fail(name, std::string{key} + " is no whole number from 1 to " +
                   std::to_string(AsciiGrid::kMaxCells));
  }
  return static_cast<std::size_t>(value);
}

/// Where the centre of the first cell is along one axis.
double first_centre(const std::map<std::string, double>& header, const std::string& axis,
                    double cell, const std::string& name) {
  if (const auto centre = header.find(axis + "llcenter"); centre != header.end()) {
    return centre->second;
  }
  return required(header, (axis + "llcorner").c_str(), name) + cell / 2.0;
}

void fill_holes(AsciiGrid& grid, const std::string& name) {
  const auto is_hole = [](float height) { return std::isnan(height); };
  grid.holes = static_cast<std::size_t>(std::ranges::count_if(grid.height_m, is_hole));
  if (grid.holes == grid.height_m.size()) {
    fail(name, "no cell has a height");
  }
  if (grid.holes > 0) {
    float lowest = std::numeric_limits<float>::max();
    for (const float height : grid.height_m) {
      lowest = std::isnan(height) ? lowest : std::min(lowest, height);
    }
    std::ranges::replace_if(grid.height_m, is_hole, lowest);
  }
}

}  // namespace

double AsciiGrid::at(double x, double y) const {
  return interpolated(height_m, columns, rows, (x - west) / cell, (y - south) / cell);
}

bool AsciiGrid::covers(double x, double y) const {
  // To the outer edges of the outermost cells.
  const double column = (x - west) / cell;
  const double row = (y - south) / cell;
  return column >= -0.5 && column <= static_cast<double>(columns) - 0.5 && row >= -0.5 &&
         row <= static_cast<double>(rows) - 0.5;
}

AsciiGrid read_ascii_grid(std::istream& stream, const std::string& name) {
  const auto header = read_header(stream, name);
  AsciiGrid grid;
  grid.columns = count_of(header, "ncols", name);
  grid.rows = count_of(header, "nrows", name);
  if (grid.columns > AsciiGrid::kMaxCells / grid.rows) {
    fail(name, "has more than " + std::to_string(AsciiGrid::kMaxCells) + " cells; cut it first");
  }
  grid.cell = required(header, "cellsize", name);
  if (!(grid.cell > 0.0)) {
    fail(name, "cellsize is not above 0");
  }
  grid.west = first_centre(header, "x", grid.cell, name);
  grid.south = first_centre(header, "y", grid.cell, name);
  const auto no_data = header.find("nodata_value");
  // Grows with what is there, not with what the header promises.
  for (std::size_t i = 0; i < grid.columns * grid.rows; ++i) {
    double height_m = 0.0;
    if (!(stream >> height_m)) {
      fail(name, "row " + std::to_string(i / grid.columns + 1) + " of " +
                     std::to_string(grid.rows) + ", column " +
                     std::to_string(i % grid.columns + 1) + " is missing or no number");
    }
    constexpr double kDeepest_m = -12'000.0;
    constexpr double kHighest_m = 9'000.0;
    const bool hole = no_data != header.end() && height_m == no_data->second;
    if (!hole && !(height_m >= kDeepest_m && height_m <= kHighest_m)) {
      fail(name, "row " + std::to_string(i / grid.columns + 1) +
                     " has a height that is not on earth; allowed: metres, or NODATA_value");
    }
    grid.height_m.push_back(hole ? std::numeric_limits<float>::quiet_NaN()
                                 : static_cast<float>(height_m));
  }
  // The file has the northernmost row first.
  for (std::size_t r = 0; r < grid.rows / 2; ++r) {
    const auto row = [&](std::size_t number) {
      return grid.height_m.begin() + static_cast<std::ptrdiff_t>(number * grid.columns);
    };
    std::swap_ranges(row(r), row(r + 1), row(grid.rows - 1 - r));
  }
  fill_holes(grid, name);
  return grid;
}

AsciiGrid read_ascii_grid(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw CityFileError{file.native() + ": there is no such file"};
  }
  std::ifstream stream{file};
  if (!stream) {
    throw CityFileError{file.native() + ": cannot be opened"};
  }
  return read_ascii_grid(stream, file.native());
}

double height_at_origin(const AsciiGrid& grid, TerrainFrame unit, const Geodetic& origin) {
  return unit == TerrainFrame::kLocal ? grid.at(0.0, 0.0)
                                      : grid.at(origin.longitude_deg, origin.latitude_deg);
}

PlacedTerrain ground_of(const AsciiGrid& grid, TerrainFrame unit, const LocalFrame& frame,
                        const Eigen::AlignedBox2d& box) {
  const auto in_grid = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (unit == TerrainFrame::kLocal) {
      return p;
    }
    const Geodetic point = frame.to_geodetic({p.x(), p.y(), 0.0});
    return {point.longitude_deg, point.latitude_deg};
  };
  PlacedTerrain ground;
  // A degree of latitude has 111.2 km, which sets the spacing of a grid in degrees.
  constexpr double kDegree_m = 111'200.0;
  const double extent_m = box.sizes().maxCoeff();
  constexpr double kMostCellsAcross = 4000.0;
  const double cell_m = std::max(grid.cell * (unit == TerrainFrame::kLocal ? 1.0 : kDegree_m),
                                 extent_m / kMostCellsAcross);
  Terrain& terrain = ground.terrain;
  terrain.south_west_m = box.min();
  terrain.cell_m = cell_m;
  terrain.columns = static_cast<std::size_t>(std::ceil(box.sizes().x() / cell_m)) + 1;
  terrain.rows = static_cast<std::size_t>(std::ceil(box.sizes().y() / cell_m)) + 1;
  const double origin_m = height_at_origin(grid, unit, frame.origin());
  terrain.height_m.reserve(terrain.columns * terrain.rows);
  for (std::size_t r = 0; r < terrain.rows; ++r) {
    for (std::size_t c = 0; c < terrain.columns; ++c) {
      const Eigen::Vector2d p = in_grid(
          box.min() + cell_m * Eigen::Vector2d{static_cast<double>(c), static_cast<double>(r)});
      terrain.height_m.push_back(static_cast<float>(grid.at(p.x(), p.y()) - origin_m));
    }
  }
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight}) {
    const Eigen::Vector2d p = in_grid(box.corner(corner));
    ground.covered = ground.covered && grid.covers(p.x(), p.y());
  }
  return ground;
}

double height_at(const Terrain& terrain, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d p = (point_m - terrain.south_west_m) / terrain.cell_m;
  return interpolated(terrain.height_m, terrain.columns, terrain.rows, p.x(), p.y());
}

}  // namespace cuscus::city
