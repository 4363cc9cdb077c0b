#pragma once

#include "common/city/city.h"

namespace cuscus::city {

inline Ring square_ring(double west_m, double south_m, double side_m) {
  return {{west_m, south_m},
          {west_m + side_m, south_m},
          {west_m + side_m, south_m + side_m},
          {west_m, south_m + side_m}};
}

/// A courtyard: clockwise.
inline Ring square_courtyard(double west_m, double south_m, double side_m) {
  return {{west_m, south_m},
          {west_m, south_m + side_m},
          {west_m + side_m, south_m + side_m},
          {west_m + side_m, south_m}};
}

/// 200 m x 100 m: a palace with a courtyard, a tower on a base, a street, a tree and a wood.
inline City sample_city() {
  City city;
  city.origin = {.latitude_deg = 44.5, .longitude_deg = 11.35, .height_m = 54.0};
  city.south_west_m = {-100.0, -50.0};
  city.north_east_m = {100.0, 50.0};
  city.buildings.push_back(
      {.osm_id = -7,
       .name = "Palazzo <A> & \"B\"",
       .prisms = {{.footprint = {.outer = square_ring(-90.0, -40.0, 40.0),
                                 .courtyards = {square_courtyard(-80.0, -30.0, 20.0)}},
                   .bottom_m = 0.0,
                   .top_m = 12.5}},
       .outer_walls = Material::kStone,
       .room_m = 5.0,
       .height_source = HeightSource::kTag});
  city.buildings.push_back({.osm_id = 8,
                            .name = {},
                            .prisms = {{{square_ring(0.0, 0.0, 30.0), {}}, 0.0, 20.0},
                                       {{square_ring(5.0, 5.0, 20.0), {}}, 20.0, 90.0}},
                            .outer_walls = Material::kGlass,
                            .room_m = 0.0,
                            .height_source = HeightSource::kLevels});
  city.streets.push_back({.osm_id = 9,
                          .name = "Via & Vicolo",
                          .axis_m = {{-100.0, -10.0}, {0.0, -10.0}, {100.0, -12.0}},
                          .width_m = 8.0});
  city.trees.push_back({.foot_m = {60.0, -30.0, 0.0}, .height_m = 9.0, .crown_radius_m = 2.5});
  city.woods.push_back(
      {.footprint = {square_ring(50.0, 10.0, 30.0), {}}, .bottom_m = 0.0, .top_m = 11.0});
  return city;
}

}  // namespace cuscus::city
