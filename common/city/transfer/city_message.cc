#include "common/city/transfer/city_message.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace cuscus::city {
namespace {

void require(bool holds, const char* rule) {
  if (!holds) {
    throw std::invalid_argument{std::string{"a city's message: "} + rule};
  }
}

void put_points(const std::vector<Eigen::Vector2d>& points,
                google::protobuf::RepeatedField<double>& numbers) {
  numbers.Reserve(static_cast<int>(2 * points.size()));
  for (const Eigen::Vector2d& point : points) {
    numbers.Add(point.x());
    numbers.Add(point.y());
  }
}

std::vector<Eigen::Vector2d> points_of(const google::protobuf::RepeatedField<double>& numbers) {
  require(numbers.size() % 2 == 0, "a ring or street lacks a coordinate");
  std::vector<Eigen::Vector2d> points;
  points.reserve(static_cast<std::size_t>(numbers.size()) / 2);
  for (int i = 0; i < numbers.size(); i += 2) {
    points.emplace_back(numbers[i], numbers[i + 1]);
  }
  return points;
}

void put_prism(const Footprint& footprint, double bottom_m, double top_m, proto::CityPrism& prism) {
  prism.set_bottom_m(bottom_m);
  prism.set_top_m(top_m);
  auto& rings = *prism.mutable_footprint();
  put_points(footprint.outer, *rings.add_rings()->mutable_corners_m());
  for (const Ring& courtyard : footprint.courtyards) {
    put_points(courtyard, *rings.add_rings()->mutable_corners_m());
  }
}

Footprint footprint_of(const proto::CityFootprint& message) {
  require(message.rings_size() > 0, "a footprint has no outer ring");
  Footprint footprint{.outer = points_of(message.rings(0).corners_m()), .courtyards = {}};
  for (int i = 1; i < message.rings_size(); ++i) {
    footprint.courtyards.push_back(points_of(message.rings(i).corners_m()));
  }
  return footprint;
}

void put_building(const Building& building, proto::CityBuilding& message) {
  message.set_osm_id(building.osm_id);
  message.set_name(building.name);
  for (const Prism& prism : building.prisms) {
    put_prism(prism.footprint, prism.bottom_m, prism.top_m, *message.add_prisms());
  }
  message.set_outer_walls(static_cast<std::uint32_t>(building.outer_walls));
  message.set_room_m(building.room_m);
  message.set_height_source(static_cast<std::uint32_t>(building.height_source));
}

Building building_of(const proto::CityBuilding& message) {
  require(message.outer_walls() < kMaterials, "a wall's material is not known");
  require(message.height_source() <= static_cast<std::uint32_t>(HeightSource::kRule),
          "a height's source is not known");
  Building building;
  building.osm_id = message.osm_id();
  building.name = message.name();
  for (const proto::CityPrism& prism : message.prisms()) {
    building.prisms.push_back({.footprint = footprint_of(prism.footprint()),
                               .bottom_m = prism.bottom_m(),
                               .top_m = prism.top_m()});
  }
  building.outer_walls = static_cast<Material>(message.outer_walls());
  building.room_m = message.room_m();
  building.height_source = static_cast<HeightSource>(message.height_source());
  return building;
}

void put_terrain(const Terrain& terrain, proto::CityTerrain& message) {
  message.set_west_m(terrain.south_west_m.x());
  message.set_south_m(terrain.south_west_m.y());
  message.set_cell_m(terrain.cell_m);
  message.set_columns(static_cast<std::uint32_t>(terrain.columns));
  message.set_rows(static_cast<std::uint32_t>(terrain.rows));
  message.mutable_height_m()->Add(terrain.height_m.begin(), terrain.height_m.end());
}

Terrain terrain_of(const proto::CityTerrain& message) {
  require(static_cast<std::size_t>(message.height_m_size()) ==
              std::size_t{message.columns()} * message.rows(),
          "the terrain's grid has not as many heights as cells");
  return {.south_west_m = {message.west_m(), message.south_m()},
          .cell_m = message.cell_m(),
          .columns = message.columns(),
          .rows = message.rows(),
          .height_m = {message.height_m().begin(), message.height_m().end()}};
}

}  // namespace

proto::CityModel to_message(const City& city) {
  proto::CityModel message;
  message.set_attribution(city.attribution);
  message.set_latitude_deg(city.origin.latitude_deg);
  message.set_longitude_deg(city.origin.longitude_deg);
  message.set_height_m(city.origin.height_m);
  message.set_west_m(city.south_west_m.x());
  message.set_south_m(city.south_west_m.y());
  message.set_east_m(city.north_east_m.x());
  message.set_north_m(city.north_east_m.y());
  for (const Building& building : city.buildings) {
    put_building(building, *message.add_buildings());
  }
  for (const Street& street : city.streets) {
    auto& to = *message.add_streets();
    to.set_osm_id(street.osm_id);
    to.set_name(street.name);
    put_points(street.axis_m, *to.mutable_axis_m());
    to.set_width_m(street.width_m);
  }
  for (const Tree& tree : city.trees) {
    auto& to = *message.add_trees();
    to.set_x_m(tree.foot_m.x());
    to.set_y_m(tree.foot_m.y());
    to.set_z_m(tree.foot_m.z());
    to.set_height_m(tree.height_m);
    to.set_crown_radius_m(tree.crown_radius_m);
  }
  for (const Wood& wood : city.woods) {
    put_prism(wood.footprint, wood.bottom_m, wood.top_m, *message.add_woods());
  }
  if (city.terrain) {
    put_terrain(*city.terrain, *message.mutable_terrain());
  }
  return message;
}

City from_message(const proto::CityModel& message) {
  City city;
  city.attribution = message.attribution();
  city.origin = {.latitude_deg = message.latitude_deg(),
                 .longitude_deg = message.longitude_deg(),
                 .height_m = message.height_m()};
  city.south_west_m = {message.west_m(), message.south_m()};
  city.north_east_m = {message.east_m(), message.north_m()};
  for (const proto::CityBuilding& building : message.buildings()) {
    city.buildings.push_back(building_of(building));
  }
  for (const proto::CityStreet& street : message.streets()) {
    city.streets.push_back({.osm_id = street.osm_id(),
                            .name = street.name(),
                            .axis_m = points_of(street.axis_m()),
                            .width_m = street.width_m()});
  }
  for (const proto::CityTree& tree : message.trees()) {
    city.trees.push_back({.foot_m = {tree.x_m(), tree.y_m(), tree.z_m()},
                          .height_m = tree.height_m(),
                          .crown_radius_m = tree.crown_radius_m()});
  }
  for (const proto::CityPrism& wood : message.woods()) {
    city.woods.push_back({.footprint = footprint_of(wood.footprint()),
                          .bottom_m = wood.bottom_m(),
                          .top_m = wood.top_m()});
  }
  if (message.has_terrain()) {
    city.terrain = terrain_of(message.terrain());
  }
  return city;
}

City from_bytes(std::span<const std::byte> message) {
  proto::CityModel model;
  require(message.size() <= std::numeric_limits<int>::max() &&
              model.ParseFromArray(message.data(), static_cast<int>(message.size())),
          "these bytes are none");
  return from_message(model);
}

}  // namespace cuscus::city
