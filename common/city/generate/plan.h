#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/city/city.h"

/// Cities that nobody has surveyed: plans in metres, made from a seed.
namespace cuscus::city::generate {

struct PlannedBuilding {
  std::string use;   ///< Value of OSM's key `building`.
  std::string name;  ///< Empty: none.
  Footprint footprint;
  double height_m{0.0};
  Material walls{Material::kConcrete};
  /// The solids that it consists of, where it is not one prism: together they have its footprint
  /// and height, and share no volume.
  std::vector<Prism> parts;
};

struct PlannedStreet {
  std::string highway;  ///< Value of OSM's key `highway`.
  std::string name;
  std::vector<Eigen::Vector2d> axis_m;
  double width_m{0.0};
};

struct Square {
  std::string name;
  Ring outline;
};

/// East and north of the area's centre, all coordinates multiples of a millimetre. Neighbours with
/// a common wall have all of its corners in common.
struct Plan {
  Eigen::Vector2d south_west_m{Eigen::Vector2d::Zero()};
  Eigen::Vector2d north_east_m{Eigen::Vector2d::Zero()};
  std::vector<PlannedBuilding> buildings;
  std::vector<PlannedStreet> streets;
  std::vector<Square> squares;
  std::vector<Tree> trees;
  std::vector<Wood> woods;
};

inline constexpr double kSmallestCity_m = 200.0;
inline constexpr double kLargestCity_m = 5000.0;

/// To whole millimetres.
[[nodiscard]] Eigen::Vector2d snapped(const Eigen::Vector2d& point_m);

/// Throws std::invalid_argument, which names the range, unless a city can have that size.
void check_size(double size_m);

}  // namespace cuscus::city::generate
