#include "common/city/generate/grid.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/city/generate/convex_cell.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/lots.h"
#include "common/city/generate/names.h"
#include "common/city/generate/planting.h"
#include "common/city/generate/tall_building.h"

namespace cuscus::city::generate {
namespace {

// The narrowest and the widest.
constexpr std::array<double, 2> kAvenues_m{25.0, 30.0};
constexpr std::array<double, 2> kStreets_m{15.0, 18.0};
constexpr double kBackToBack = 0.6;  // of the lots that are deep enough
constexpr double kDeepLot_m = 44.0;
constexpr double kAlone = 0.3;  // of the lots
constexpr double kAvenueTreesApart_m = 22.0;
constexpr double kTreesFromKerb_m = 2.5;

/// Roads in one direction.
struct Roads {
  std::vector<double> at_m;  ///< From the middle, growing.
  std::vector<double> width_m;

  /// What is free between road i and the next.
  [[nodiscard]] double from(std::size_t i) const { return at_m[i] + width_m[i] / 2.0; }
  [[nodiscard]] double to(std::size_t i) const { return at_m[i + 1] - width_m[i + 1] / 2.0; }
  [[nodiscard]] std::size_t gaps() const { return at_m.size() - 1; }
};

/// The outermost ones lie within the size whatever their width.
Roads lay_roads(double size_m, double apart_m, const std::array<double, 2>& widths_m, Dice& dice) {
  const long gaps = std::max(1L, std::lround(size_m / apart_m));
  Roads roads;
  for (long i = 0; i <= gaps; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(gaps);
    roads.at_m.push_back(std::round((part - 0.5) * (size_m - widths_m[1]) * 1000.0) / 1000.0);
    roads.width_m.push_back(dice.tenths(widths_m[0], widths_m[1]));
  }
  return roads;
}

/// A block's lots: frontages of 20 to 40 m on the streets, some divided back to back.
std::vector<ConvexCell> lots_in(const Eigen::Vector2d& south_west,
                                const Eigen::Vector2d& north_east, Dice& dice) {
  std::vector<ConvexCell> lots;
  const double depth_m = north_east.y() - south_west.y();
  double west_m = south_west.x();
  while (west_m < north_east.x()) {
    double east_m = west_m + dice.uniform(20.0, 40.0);
    if (north_east.x() - east_m < 20.0) {
      east_m = north_east.x();
    }
    if (depth_m > kDeepLot_m && dice.chance(kBackToBack)) {
      const double middle_m = south_west.y() + depth_m * dice.uniform(0.42, 0.58);
      lots.push_back(rectangle({west_m, south_west.y()}, {east_m, middle_m}));
      lots.push_back(rectangle({west_m, middle_m}, {east_m, north_east.y()}));
    } else {
      lots.push_back(rectangle({west_m, south_west.y()}, {east_m, north_east.y()}));
    }
    west_m = east_m;
  }
  return lots;
}

class Grid {
 public:
  Grid(const GridParameters& parameters, std::uint64_t seed)
      : parameters_{parameters}, seed_{seed} {}

  Plan plan() {
    const double half_m = parameters_.size_m / 2.0;
    plan_.south_west_m = {-half_m, -half_m};
    plan_.north_east_m = {half_m, half_m};
    Dice dice{seed_, Purpose::kStreets};
    avenues_ = lay_roads(parameters_.size_m, parameters_.avenues_apart_m, kAvenues_m, dice);
    streets_ = lay_roads(parameters_.size_m, parameters_.streets_apart_m, kStreets_m, dice);
    name_roads();
    const std::size_t park_column = avenues_.gaps() / 2;
    const std::size_t park_row = streets_.gaps() / 2;
    for (std::size_t row = 0; row < streets_.gaps(); ++row) {
      for (std::size_t column = 0; column < avenues_.gaps(); ++column) {
        const Eigen::Vector2d south_west{avenues_.from(column), streets_.from(row)};
        const Eigen::Vector2d north_east{avenues_.to(column), streets_.to(row)};
        Dice block_dice{seed_, Purpose::kBlock, row * avenues_.gaps() + column};
        if (row == park_row && column == park_column) {
          make_park(rectangle(south_west, north_east), block_dice);
        } else {
          build(south_west, north_east, block_dice);
        }
      }
    }
    plant_avenues();
    return std::move(plan_);
  }

 private:
  void name_roads();
  void make_park(const ConvexCell& block, Dice& dice);
  void build(const Eigen::Vector2d& south_west, const Eigen::Vector2d& north_east, Dice& dice);
  void plant_avenues();

  GridParameters parameters_;
  std::uint64_t seed_;
  Roads avenues_;
  Roads streets_;
  Plan plan_;
};

/// Avenues count eastwards, streets northwards; they have their crossings in common.
void Grid::name_roads() {
  for (std::size_t i = 0; i < avenues_.at_m.size(); ++i) {
    PlannedStreet avenue{.highway = "primary",
                         .name = fmt::format("{} Avenue", ordinal(i + 1)),
                         .axis_m = {},
                         .width_m = avenues_.width_m[i]};
    for (const double y_m : streets_.at_m) {
      avenue.axis_m.emplace_back(avenues_.at_m[i], y_m);
    }
    plan_.streets.push_back(std::move(avenue));
  }
  for (std::size_t i = 0; i < streets_.at_m.size(); ++i) {
    PlannedStreet street{.highway = "residential",
                         .name = fmt::format("{} Street", ordinal(i + 1)),
                         .axis_m = {},
                         .width_m = streets_.width_m[i]};
    for (const double x_m : avenues_.at_m) {
      street.axis_m.emplace_back(x_m, streets_.at_m[i]);
    }
    plan_.streets.push_back(std::move(street));
  }
}

void Grid::make_park(const ConvexCell& block, Dice& dice) {
  plan_.squares.push_back({.name = "City Park", .outline = snapped_ring(ring_of(block))});
  plant_around(block, kAvenueTreesApart_m / 2.0, dice, plan_.trees);
  constexpr double kLawn_m = 14.0;
  if (const ConvexCell middle = inset(block, kLawn_m); !middle.empty()) {
    plan_.woods.push_back(wood_on(middle, dice));
  }
}

void Grid::build(const Eigen::Vector2d& south_west, const Eigen::Vector2d& north_east, Dice& dice) {
  std::vector<ConvexCell> lots = lots_in(south_west, north_east, dice);
  for (ConvexCell& lot : lots) {
    if (dice.chance(kAlone)) {
      lot = inset(lot, dice.uniform(1.0, 2.5));
    }
  }
  const auto outlines = outlines_with_common_corners(lots);
  for (std::size_t i = 0; i < lots.size(); ++i) {
    const double height_m = dice.tenths(parameters_.lowest_m, parameters_.highest_m);
    plan_.buildings.push_back(tall_building(lots[i], outlines[i], height_m, dice));
  }
}

/// Between crossings, on both sides.
void Grid::plant_avenues() {
  Dice dice{seed_, Purpose::kTrees};
  constexpr double kFromCrossing_m = 4.0;
  for (std::size_t i = 0; i < avenues_.at_m.size(); ++i) {
    const double aside_m = avenues_.width_m[i] / 2.0 - kTreesFromKerb_m;
    for (const double x_m : {avenues_.at_m[i] - aside_m, avenues_.at_m[i] + aside_m}) {
      for (std::size_t row = 0; row < streets_.gaps(); ++row) {
        plant_row({x_m, streets_.from(row) + kFromCrossing_m},
                  {x_m, streets_.to(row) - kFromCrossing_m}, kAvenueTreesApart_m, dice,
                  plan_.trees);
      }
    }
  }
}

}  // namespace

Plan grid(const GridParameters& parameters, std::uint64_t seed) {
  check_size(parameters.size_m);
  return Grid{parameters, seed}.plan();
}

}  // namespace cuscus::city::generate
