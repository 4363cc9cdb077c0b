#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/city/city.h"

namespace cuscus::world {

/// An upright block, for tests.
struct Block {
  Eigen::Vector3d low_m;
  Eigen::Vector3d high_m;
};

/// A city of one building per block, on the plane z = 0.
inline city::City city_of(const std::vector<Block>& blocks) {
  city::City city;
  for (const auto& [low, high] : blocks) {
    city::Building building;
    building.prisms.push_back({.footprint = {.outer = {{low.x(), low.y()},
                                                       {high.x(), low.y()},
                                                       {high.x(), high.y()},
                                                       {low.x(), high.y()}},
                                             .courtyards = {}},
                               .bottom_m = low.z(),
                               .top_m = high.z()});
    city.buildings.push_back(building);
  }
  return city;
}

}  // namespace cuscus::world
