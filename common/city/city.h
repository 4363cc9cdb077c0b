#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cuscus::city {

/// East and north [m] in the city's frame: ENU, tangent to WGS-84 at City::origin.
using Ring = std::vector<Eigen::Vector2d>;

/// A simple polygon with courtyards. Rings are open: the last corner is not the first. The outer
/// ring is counter-clockwise, courtyards are clockwise; none touches itself or another but in
/// single corners.
struct Footprint {
  Ring outer;
  std::vector<Ring> courtyards;
};

/// Upright walls around a footprint, under a flat roof and over a flat bottom.
struct Prism {
  Footprint footprint;
  double bottom_m{0.0};  ///< Up, in the city's frame.
  double top_m{0.0};
};

/// What walls are made of.
enum class Material : std::uint8_t { kStone, kConcrete, kBrick, kGlass, kMetal, kWood };
inline constexpr std::size_t kMaterials = 6;

/// Where a height came from.
enum class HeightSource : std::uint8_t { kTag, kLevels, kRule };

/// One solid: the union of its prisms, which share no volume (surfaces may touch). A wall between
/// two of them is no wall.
struct Building {
  std::int64_t osm_id{0};  ///< Of the way; negative: of the relation with that number.
  std::string name;        ///< Empty: none.
  std::vector<Prism> prisms;
  Material outer_walls{Material::kConcrete};
  double room_m{0.0};  ///< Mean distance between inner walls; 0: none.
  HeightSource height_source{HeightSource::kRule};
};

struct Street {
  std::int64_t osm_id{0};
  std::string name;
  std::vector<Eigen::Vector2d> axis_m;
  double width_m{0.0};
};

struct Tree {
  Eigen::Vector3d foot_m{Eigen::Vector3d::Zero()};
  double height_m{0.0};
  double crown_radius_m{0.0};
};

struct Wood {
  Footprint footprint;
  double bottom_m{0.0};
  double top_m{0.0};
};

/// Heights of the ground on a grid whose rows run north, from its south-west corner on.
struct Terrain {
  Eigen::Vector2d south_west_m{Eigen::Vector2d::Zero()};
  double cell_m{1.0};
  std::size_t columns{0};
  std::size_t rows{0};
  std::vector<float> height_m;  ///< Of row r, column c: [r * columns + c].
};

/// Degrees of WGS-84, and metres above its ellipsoid.
struct Geodetic {
  double latitude_deg{0.0};
  double longitude_deg{0.0};
  double height_m{0.0};
};

/// What stands and grows in an area. Everything in metres, ENU, in one frame; without terrain the
/// ground is the plane z = 0.
struct City {
  /// Whose data they are, for everything that shows them; empty for what nobody has surveyed.
  std::string attribution;
  Geodetic origin;
  Eigen::Vector2d south_west_m{Eigen::Vector2d::Zero()};
  Eigen::Vector2d north_east_m{Eigen::Vector2d::Zero()};
  std::vector<Building> buildings;
  std::vector<Street> streets;
  std::vector<Tree> trees;
  std::vector<Wood> woods;
  std::optional<Terrain> terrain;
};

}  // namespace cuscus::city
