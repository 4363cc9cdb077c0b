#include "common/city/geometry/ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace cuscus::city {
namespace {

/// Appends where x(t) = start + t way is a line of a grid of `lines`, between 0 and 1.
void append_lines(double start, double way, std::size_t lines, std::vector<double>& at) {
  if (way == 0.0) {
    return;
  }
  const double last = static_cast<double>(lines) - 1.0;
  const double low = std::clamp(std::ceil(std::min(start, start + way)), 0.0, last + 1.0);
  const double high = std::clamp(std::floor(std::max(start, start + way)), -1.0, last);
  const auto end = static_cast<std::int64_t>(high) + 1;
  for (auto line = static_cast<std::int64_t>(low); line < end; ++line) {
    at.push_back(std::clamp((static_cast<double>(line) - start) / way, 0.0, 1.0));
  }
}

/// The first t in [0, 1] at which c + b t + a t² goes from above 0 to 0.
std::optional<double> first_root(double a, double b, double c) {
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) {
    return std::nullopt;
  }
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  std::optional<double> first;
  for (const double root : {q / a, c / q}) {
    if (root >= 0.0 && root <= 1.0 && (!first || root < *first)) {
      first = root;
    }
  }
  return first;
}

}  // namespace

Ground::Cell Ground::cell_at(const Eigen::Vector2d& p) const {
  const Terrain& terrain = *terrain_;
  const auto place = [](double at, std::size_t lines) {
    const double within = std::clamp(at, 0.0, static_cast<double>(lines) - 1.0);
    const double line =
        std::min(std::floor(within), std::max(static_cast<double>(lines) - 2.0, 0.0));
    return std::pair{static_cast<std::size_t>(line), within - line};
  };
  const Eigen::Vector2d at = (p - terrain.south_west_m) / terrain.cell_m;
  const auto [column, east] = place(at.x(), terrain.columns);
  const auto [row, north] = place(at.y(), terrain.rows);
  const std::size_t next_column = std::min(column + 1, terrain.columns - 1);
  const std::size_t next_row = std::min(row + 1, terrain.rows - 1);
  const auto height = [&terrain](std::size_t r, std::size_t c) {
    return static_cast<double>(terrain.height_m[r * terrain.columns + c]);
  };
  return {.within = {east, north},
          .south_west = height(row, column),
          .south_east = height(row, next_column),
          .north_west = height(next_row, column),
          .north_east = height(next_row, next_column)};
}

double Ground::height_m(const Eigen::Vector2d& p) const {
  if (!terrain_) {
    return 0.0;
  }
  const Cell cell = cell_at(p);
  return std::lerp(std::lerp(cell.south_west, cell.south_east, cell.within.x()),
                   std::lerp(cell.north_west, cell.north_east, cell.within.x()), cell.within.y());
}

Eigen::Vector3d Ground::normal(const Eigen::Vector2d& p) const {
  if (!terrain_) {
    return Eigen::Vector3d::UnitZ();
  }
  const Cell cell = cell_at(p);
  const Eigen::Vector2d at = (p - terrain_->south_west_m) / terrain_->cell_m;
  const auto beyond = [](double x, std::size_t lines) {
    return x < 0.0 || x > static_cast<double>(lines) - 1.0;
  };
  const double east = std::lerp(cell.south_east - cell.south_west,
                                cell.north_east - cell.north_west, cell.within.y());
  const double north = std::lerp(cell.north_west - cell.south_west,
                                 cell.north_east - cell.south_east, cell.within.x());
  return Eigen::Vector3d{beyond(at.x(), terrain_->columns) ? 0.0 : -east / terrain_->cell_m,
                         beyond(at.y(), terrain_->rows) ? 0.0 : -north / terrain_->cell_m, 1.0}
      .normalized();
}

double Ground::lowest_m() const {
  if (!terrain_) {
    return 0.0;
  }
  return static_cast<double>(
      *std::min_element(terrain_->height_m.begin(), terrain_->height_m.end()));
}

std::vector<double> Ground::pieces(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  std::vector<double> at{0.0, 1.0};
  if (terrain_) {
    const Eigen::Vector2d start = (a.head<2>() - terrain_->south_west_m) / terrain_->cell_m;
    const Eigen::Vector2d way = (b - a).head<2>() / terrain_->cell_m;
    append_lines(start.x(), way.x(), terrain_->columns, at);
    append_lines(start.y(), way.y(), terrain_->rows, at);
    std::sort(at.begin(), at.end());
  }
  return at;
}

std::optional<double> Ground::hit(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const auto height_above = [&](double t) {
    const Eigen::Vector3d p = a + t * (b - a);
    return p.z() - height_m(p.head<2>());
  };
  if (height_above(0.0) < 0.0) {
    return 0.0;
  }
  const std::vector<double> at = pieces(a, b);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    // Between two lines of the grid the height above ground is a parabola.
    const double width = at[i + 1] - at[i];
    const double begin = height_above(at[i]);
    const double middle = height_above(at[i] + 0.5 * width);
    const double end = height_above(at[i + 1]);
    const double bend = 2.0 * (begin - 2.0 * middle + end);
    if (end >= 0.0 && !(bend > 0.0 && middle < std::max(begin, end))) {
      continue;
    }
    const double slope = end - begin - bend;
    const auto root = first_root(bend, slope, std::max(begin, 0.0));
    if (root && (end < 0.0 || bend * *root * 2.0 + slope < 0.0)) {
      return at[i] + *root * width;
    }
    if (end < 0.0) {
      return at[i + 1];  // rounding alone has hidden the root
    }
  }
  return std::nullopt;
}

double Ground::distance_m(const Eigen::Vector3d& p) const {
  return (p.z() - height_m(p.head<2>())) * normal(p.head<2>()).z();
}

std::optional<double> Ground::contact(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                      double radius_m) const {
  const Eigen::Vector3d way = b - a;
  const auto gap_m = [&](double t) { return distance_m(a + t * way) - radius_m; };
  bool free = gap_m(0.0) > 0.0;
  if (!free && way.dot(normal(a.head<2>())) < 0.0) {
    return 0.0;
  }
  if (!terrain_) {
    return free && gap_m(1.0) <= 0.0 ? std::optional{(radius_m - a.z()) / way.z()} : std::nullopt;
  }
  constexpr int kPlaces = 4;
  constexpr int kHalvings = 48;
  const std::optional<double> below = hit(a, b);
  const double last = below.value_or(1.0);
  const std::vector<double> at = pieces(a, b);
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    for (int place = 1; place <= kPlaces; ++place) {
      double behind = std::min(last, std::lerp(at[i], at[i + 1], place / double{kPlaces}));
      if (gap_m(behind) > 0.0) {
        free = true;
        before = behind;
        continue;
      }
      if (!free) {
        continue;  // it leaves what it touched from the start
      }
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (before + behind);
        (gap_m(middle) > 0.0 ? before : behind) = middle;
      }
      return before;
    }
  }
  return below;
}

}  // namespace cuscus::city
