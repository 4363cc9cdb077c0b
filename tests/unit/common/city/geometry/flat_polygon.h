#pragma once

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

#include "common/city/city.h"

// Footprints for Boost.Geometry, the oracle.
namespace cuscus::city {

using FlatPoint = boost::geometry::model::d2::point_xy<double>;
using FlatPolygon = boost::geometry::model::polygon<FlatPoint, false>;  // counter-clockwise

inline FlatPolygon flat(const Footprint& footprint) {
  FlatPolygon polygon;
  for (const Eigen::Vector2d& p : footprint.outer) {
    polygon.outer().emplace_back(p.x(), p.y());
  }
  for (const Ring& courtyard : footprint.courtyards) {
    polygon.inners().emplace_back();
    for (const Eigen::Vector2d& p : courtyard) {
      polygon.inners().back().emplace_back(p.x(), p.y());
    }
  }
  boost::geometry::correct(polygon);  // closes the rings
  return polygon;
}

}  // namespace cuscus::city
