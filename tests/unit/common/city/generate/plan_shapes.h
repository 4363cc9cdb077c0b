#pragma once

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <vector>

#include "common/city/city.h"

/// Boost.Geometry's view of a city's shapes: an independent judge.
namespace cuscus::city::generate {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false, false>;  // counter-clockwise, open
using Line = bg::model::linestring<Point>;

inline Polygon polygon_of(const Footprint& footprint) {
  Polygon polygon;
  for (const auto& p : footprint.outer) {
    polygon.outer().emplace_back(p.x(), p.y());
  }
  for (const Ring& courtyard : footprint.courtyards) {
    auto& inner = polygon.inners().emplace_back();
    for (const auto& p : courtyard) {
      inner.emplace_back(p.x(), p.y());
    }
  }
  return polygon;
}

inline Line line_of(const std::vector<Eigen::Vector2d>& axis) {
  Line line;
  for (const auto& p : axis) {
    line.emplace_back(p.x(), p.y());
  }
  return line;
}

}  // namespace cuscus::city::generate
