#include "common/city/import/footprints.h"

#include <algorithm>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/algorithms/difference.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_linestring.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>

namespace cuscus::city {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false, false>;  // counter-clockwise, open
using MultiPolygon = bg::model::multi_polygon<Polygon>;
using Line = bg::model::linestring<Point>;
using BoostBox = bg::model::box<Point>;

/// Where two operations disagree by less, they agree.
constexpr double kAreaNoise_m2 = 1e-3;
constexpr double kGrid_m = 1e-3;

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

Footprint on_grid(Footprint footprint) {
  const auto snap = [](Ring& ring) {
    for (auto& p : ring) {
      p = (p / kGrid_m).array().round() * kGrid_m;
    }
  };
  snap(footprint.outer);
  std::ranges::for_each(footprint.courtyards, snap);
  return footprint;
}

struct Overlay {
  MultiPolygon rest;  ///< Of the one, beside the other.
  double common_m2{0.0};
};

/// None: Boost.Geometry failed, or contradicts itself. 1.74 sometimes does, where edges almost lie
/// on one another.
std::optional<Overlay> overlay(const Footprint& one, const Footprint& other) {
  try {
    const Polygon from = polygon_of(one);
    const Polygon what = polygon_of(other);
    Overlay result;
    MultiPolygon common;
    bg::difference(from, what, result.rest);
    bg::intersection(from, what, common);
    result.common_m2 = bg::area(common);
    const double expected_m2 = bg::area(from) - result.common_m2;
    const bool agree =
        std::abs(bg::area(result.rest) - expected_m2) < kAreaNoise_m2 + 1e-6 * bg::area(from);
    return agree ? std::optional{std::move(result)} : std::nullopt;
  } catch (const bg::exception&) {
    return std::nullopt;
  }
}

/// With a second attempt on rounded corners.
std::optional<Overlay> careful_overlay(const Footprint& one, const Footprint& other) {
  auto result = overlay(one, other);
  return result ? std::move(result) : overlay(on_grid(one), on_grid(other));
}

/// None: cannot be known.
std::optional<std::vector<Footprint>> difference(const Footprint& whole, const Footprint& other) {
  const auto result = careful_overlay(whole, other);
  if (!result) {
    return std::nullopt;
  }
  if (result->common_m2 < kAreaNoise_m2) {
    return std::vector{whole};
  }
  std::vector<Footprint> pieces;
  for (const Polygon& piece : result->rest) {
    if (auto usable = normalized(footprint_of(piece))) {
      pieces.push_back(std::move(*usable));
    }
  }
  return pieces;
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

std::optional<double> overlap_m2(const Footprint& one, const Footprint& other) {
  if (!bounds_of(one).intersects(bounds_of(other))) {
    return 0.0;
  }
  try {
    MultiPolygon common;
    bg::intersection(polygon_of(one), polygon_of(other), common);
    if (bg::area(common) < kAreaNoise_m2) {
      return 0.0;
    }
  } catch (const bg::exception&) {
    // Once more below.
  }
  const auto result = careful_overlay(one, other);
  return result ? std::optional{result->common_m2} : std::nullopt;
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

Remainder subtract(const Footprint& whole, std::span<const Footprint* const> others,
                   double thinnest_m) {
  Remainder result{.pieces = {whole}};
  bool cut = false;
  for (const Footprint* other : others) {
    const Eigen::AlignedBox2d box = bounds_of(*other);
    std::vector<Footprint> left;
    for (Footprint& piece : result.pieces) {
      if (!box.intersects(bounds_of(piece))) {
        left.push_back(std::move(piece));
        continue;
      }
      const auto pieces = difference(piece, *other);
      if (!pieces) {
        result.exact = false;
        left.push_back(std::move(piece));
        continue;
      }
      cut = cut || pieces->size() != 1 || area_m2(pieces->front()) != area_m2(piece);
      left.insert(left.end(), pieces->begin(), pieces->end());
    }
    result.pieces = std::move(left);
  }
  if (cut) {
    std::erase_if(result.pieces,
                  [&](const Footprint& piece) { return mean_width_m(piece) < thinnest_m; });
  }
  return result;
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
