#include "common/city/import/footprints.h"

#include <algorithm>
#include <boost/geometry/algorithms/area.hpp>
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

/// None: Boost.Geometry failed, or contradicts itself.
std::optional<std::vector<Footprint>> difference(const Footprint& whole, const Footprint& other) {
  try {
    const Polygon from = polygon_of(whole);
    const Polygon what = polygon_of(other);
    MultiPolygon rest;
    MultiPolygon common;
    bg::difference(from, what, rest);
    bg::intersection(from, what, common);
    const double expected_m2 = bg::area(from) - bg::area(common);
    if (!(std::abs(bg::area(rest) - expected_m2) < kAreaNoise_m2 + 1e-6 * bg::area(from))) {
      return std::nullopt;
    }
    if (bg::area(common) < kAreaNoise_m2) {
      return std::vector{whole};
    }
    std::vector<Footprint> pieces;
    for (const Polygon& piece : rest) {
      if (auto usable = normalized(footprint_of(piece))) {
        pieces.push_back(std::move(*usable));
      }
    }
    return pieces;
  } catch (const bg::exception&) {
    return std::nullopt;
  }
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

double overlap_m2(const Footprint& one, const Footprint& other) {
  MultiPolygon common;
  try {
    bg::intersection(polygon_of(one), polygon_of(other), common);
  } catch (const bg::exception&) {
    return 0.0;
  }
  return bg::area(common);
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
      auto pieces = difference(piece, *other);
      if (!pieces) {
        pieces = difference(on_grid(piece), on_grid(*other));
      }
      if (!pieces) {
        result.exact = false;
        left.push_back(std::move(piece));
        continue;
      }
      cut = cut || pieces->size() != 1 || area_m2(pieces->front()) != area_m2(piece);
      std::ranges::move(*pieces, std::back_inserter(left));
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
