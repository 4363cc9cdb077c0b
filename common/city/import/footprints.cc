#include "common/city/import/footprints.h"

#include <algorithm>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_linestring.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/polygon/polygon.hpp>
#include <cmath>
#include <iterator>

namespace cuscus::city {
namespace {

namespace bg = boost::geometry;
namespace gtl = boost::polygon;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false, false>;  // counter-clockwise, open
using MultiPolygon = bg::model::multi_polygon<Polygon>;
using Line = bg::model::linestring<Point>;
using BoostBox = bg::model::box<Point>;

/// Overlays are worked out in whole steps of this: Boost.Polygon is exact on integers, where
/// Boost.Geometry 1.74 gives wrong results that agree with one another, for edges that almost lie
/// on one another.
constexpr double kGrid_m = 1e-4;  // of 32 bits: 214 km to either side
using Cells = gtl::polygon_set_data<int>;
using CellPolygon = gtl::polygon_with_holes_data<int>;

Polygon polygon_of(const Footprint& footprint) {
  Polygon polygon;
  const auto fill = [](auto& to, const Ring& from) {
    to.reserve(from.size());
    for (const auto& p : from) {
      to.emplace_back(p.x(), p.y());
    }
  };
  fill(polygon.outer(), footprint.outer);
  polygon.inners().resize(footprint.courtyards.size());
  for (std::size_t i = 0; i < footprint.courtyards.size(); ++i) {
    fill(polygon.inners()[i], footprint.courtyards[i]);
  }
  return polygon;
}

Footprint footprint_of(const Polygon& polygon) {
  Footprint footprint;
  const auto fill = [](Ring& to, const auto& from) {
    to.reserve(from.size());
    for (const auto& p : from) {
      to.emplace_back(p.x(), p.y());
    }
  };
  fill(footprint.outer, polygon.outer());
  for (const auto& inner : polygon.inners()) {
    fill(footprint.courtyards.emplace_back(), inner);
  }
  return footprint;
}

gtl::polygon_data<int> cells_of(const Ring& ring) {
  std::vector<gtl::point_data<int>> corners;
  corners.reserve(ring.size());
  for (const auto& p : ring) {
    corners.emplace_back(static_cast<int>(std::lround(p.x() / kGrid_m)),
                         static_cast<int>(std::lround(p.y() / kGrid_m)));
  }
  return {corners.begin(), corners.end()};
}

void insert(const Footprint& footprint, Cells& cells) {
  cells.insert(cells_of(footprint.outer));
  for (const Ring& courtyard : footprint.courtyards) {
    cells.insert(cells_of(courtyard), true);
  }
}

Cells cells_of(const Footprint& footprint) {
  Cells cells;
  insert(footprint, cells);
  return cells;
}

template <typename Corners>
Ring ring_of(const Corners& begin, const Corners& end) {
  Ring ring;
  for (auto corner = begin; corner != end; ++corner) {
    ring.emplace_back((*corner).x() * kGrid_m, (*corner).y() * kGrid_m);
  }
  return ring;
}

Footprint footprint_of(const CellPolygon& polygon) {
  Footprint footprint{.outer = ring_of(polygon.begin(), polygon.end()), .courtyards = {}};
  for (auto hole = polygon.begin_holes(); hole != polygon.end_holes(); ++hole) {
    footprint.courtyards.push_back(ring_of(hole->begin(), hole->end()));
  }
  return footprint;
}

double area_m2(const Cells& cells) {
  return static_cast<double>(gtl::area(cells)) * kGrid_m * kGrid_m;
}

double perimeter_m(const Ring& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  }
  return sum;
}

bool tidy(Ring& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) {
    ring.pop_back();
  }
  constexpr double kNoArea_m2 = 1e-6;
  return ring.size() >= 3 && std::abs(signed_area_m2(ring)) > kNoArea_m2;
}

}  // namespace

double signed_area_m2(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    // From the first corner on, which keeps the products small.
    const Eigen::Vector2d a = ring[i] - ring[0];
    const Eigen::Vector2d b = ring[(i + 1) % ring.size()] - ring[0];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2.0;
}

double area_m2(const Footprint& footprint) {
  double area = std::abs(signed_area_m2(footprint.outer));
  for (const Ring& courtyard : footprint.courtyards) {
    area -= std::abs(signed_area_m2(courtyard));
  }
  return area;
}

double mean_width_m(const Footprint& footprint) {
  double perimeter = perimeter_m(footprint.outer);
  for (const Ring& courtyard : footprint.courtyards) {
    perimeter += perimeter_m(courtyard);
  }
  return 2.0 * area_m2(footprint) / perimeter;
}

Eigen::AlignedBox2d bounds_of(const Footprint& footprint) {
  Eigen::AlignedBox2d box;
  for (const auto& p : footprint.outer) {
    box.extend(p);
  }
  return box;
}

bool holds_corners(const Footprint& outer, const Footprint& inner) {
  const Polygon polygon = polygon_of(outer);
  return std::ranges::all_of(inner.outer, [&](const auto& p) {
    return bg::covered_by(Point{p.x(), p.y()}, polygon);
  });
}

double overlap_m2(const Footprint& one, const Footprint& other) {
  if (!bounds_of(one).intersects(bounds_of(other))) {
    return 0.0;
  }
  using namespace gtl::operators;  // NOLINT(google-build-using-namespace): its set operators
  return area_m2(Cells{cells_of(one) & cells_of(other)});
}

std::optional<Footprint> normalized(Footprint footprint) {
  if (!tidy(footprint.outer)) {
    return std::nullopt;
  }
  std::erase_if(footprint.courtyards, [](Ring& ring) { return !tidy(ring); });
  if (signed_area_m2(footprint.outer) < 0.0) {
    std::ranges::reverse(footprint.outer);
  }
  for (Ring& courtyard : footprint.courtyards) {
    if (signed_area_m2(courtyard) > 0.0) {
      std::ranges::reverse(courtyard);
    }
  }
  return footprint;
}

std::vector<Footprint> subtract(const Footprint& whole, std::span<const Footprint* const> others,
                                double thinnest_m) {
  const Eigen::AlignedBox2d box = bounds_of(whole);
  Cells taken;
  for (const Footprint* other : others) {
    if (box.intersects(bounds_of(*other))) {
      insert(*other, taken);
    }
  }
  using namespace gtl::operators;  // NOLINT(google-build-using-namespace): its set operators
  const Cells rest = cells_of(whole) - taken;
  if (taken.empty() || area_m2(cells_of(whole)) - area_m2(rest) < kTouching_m2) {
    return {whole};
  }
  std::vector<CellPolygon> polygons;
  rest.get(polygons);
  std::vector<Footprint> pieces;
  for (const CellPolygon& polygon : polygons) {
    auto piece = normalized(footprint_of(polygon));
    if (piece && mean_width_m(*piece) >= thinnest_m) {
      pieces.push_back(std::move(*piece));
    }
  }
  return pieces;
}

std::vector<Footprint> clip(const Footprint& footprint, const Eigen::AlignedBox2d& box) {
  if (box.contains(bounds_of(footprint))) {
    return {footprint};
  }
  MultiPolygon common;
  try {
    const BoostBox boost_box{{box.min().x(), box.min().y()}, {box.max().x(), box.max().y()}};
    bg::intersection(polygon_of(footprint), boost_box, common);
  } catch (const bg::exception&) {
    return {footprint};
  }
  std::vector<Footprint> pieces;
  for (const Polygon& piece : common) {
    if (auto usable = normalized(footprint_of(piece))) {
      pieces.push_back(std::move(*usable));
    }
  }
  return pieces;
}

std::vector<std::vector<Eigen::Vector2d>> clip_line(const std::vector<Eigen::Vector2d>& line,
                                                    const Eigen::AlignedBox2d& box) {
  if (std::ranges::all_of(line, [&](const auto& p) { return box.contains(p); })) {
    return {line};
  }
  Line boost_line;
  for (const auto& p : line) {
    boost_line.emplace_back(p.x(), p.y());
  }
  const BoostBox boost_box{{box.min().x(), box.min().y()}, {box.max().x(), box.max().y()}};
  bg::model::multi_linestring<Line> common;
  bg::intersection(boost_line, boost_box, common);
  std::vector<std::vector<Eigen::Vector2d>> pieces;
  for (const Line& piece : common) {
    auto& points = pieces.emplace_back();
    for (const Point& p : piece) {
      points.emplace_back(p.x(), p.y());
    }
  }
  std::erase_if(pieces, [](const auto& piece) { return piece.size() < 2; });
  return pieces;
}

}  // namespace cuscus::city
