#include "common/city/generate/old_town.h"

#include <algorithm>
#include <limits>
#include <set>

#include "common/city/generate/church.h"
#include "common/city/generate/dice.h"
#include "common/city/generate/lots.h"
#include "common/city/generate/names.h"
#include "common/city/generate/planting.h"
#include "common/city/generate/street_web.h"
#include "common/city/generate/voronoi.h"

namespace cuscus::city::generate {
namespace {

constexpr double kWallStreet_m = 8.0;    // around the town, within its size
constexpr double kLongStreet_m = 200.0;  // from here on, a street is one of the wider ones
constexpr double kShortestWall_m = 1.0;
constexpr double kSmallestHouse_m2 = 60.0;
constexpr double kNarrowestHouse_m = 5.0;
constexpr double kTreesApart_m = 9.0;
constexpr LotSizes kHouses{.largest_m2 = 520.0, .smallest_m2 = 110.0, .narrowest_m = 7.0};
constexpr double kPalaces = 0.3;  // of the blocks
constexpr double kCourtyards = 0.6;
constexpr double kStoneWalls = 0.7;

/// Cells with a use of their own.
struct OpenPlaces {
  std::size_t market{0};
  std::size_t small_square{0};
  std::size_t church{0};
  std::size_t garden{0};
};

class OldTown {
 public:
  OldTown(const OldTownParameters& parameters, std::uint64_t seed)
      : parameters_{parameters},
        seed_{seed},
        cells_{irregular_cells(
            {.size_m = parameters.size_m - kWallStreet_m, .pitch_m = parameters.block_m}, seed)},
        web_{street_web(cells_)} {}

  Plan plan() {
    const double half_m = parameters_.size_m / 2.0;
    plan_.south_west_m = {-half_m, -half_m};
    plan_.north_east_m = {half_m, half_m};
    lay_streets();
    const OpenPlaces open = choose_open_places();
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      const ConvexCell block = block_of(cell);
      Dice dice{seed_, Purpose::kBlock, cell};
      if (cell == open.market || cell == open.small_square) {
        make_square(block, cell == open.market ? "Market Square" : "Well Square", dice);
      } else if (cell == open.church) {
        make_churchyard(block, dice);
      } else if (cell == open.garden && !block.empty()) {
        plan_.woods.push_back(wood_on(block, dice));
      } else {
        build(block, dice);
      }
    }
    return std::move(plan_);
  }

 private:
  void lay_streets();
  [[nodiscard]] OpenPlaces choose_open_places() const;
  [[nodiscard]] ConvexCell block_of(std::size_t cell) const;
  void make_square(const ConvexCell& block, const char* name, Dice& dice);
  void make_churchyard(const ConvexCell& block, Dice& dice);
  void build(const ConvexCell& block, Dice& dice);

  OldTownParameters parameters_;
  std::uint64_t seed_;
  std::vector<ConvexCell> cells_;
  StreetWeb web_;
  Plan plan_;
};

std::string kind_of_lane(double width_m) {
  constexpr double kCarsFit_m = 5.0;
  constexpr double kCartsFit_m = 3.5;
  return width_m >= kCarsFit_m    ? "residential"
         : width_m >= kCartsFit_m ? "living_street"
                                  : "pedestrian";
}

void OldTown::lay_streets() {
  const auto names = old_street_names(web_.streets.size(), seed_);
  for (std::size_t i = 0; i < web_.streets.size(); ++i) {
    const StreetWeb::Street& street = web_.streets[i];
    Dice dice{seed_, Purpose::kStreets, i};
    const double width_m = street.outer                      ? kWallStreet_m
                           : street.length_m > kLongStreet_m ? dice.tenths(4.5, 8.0)
                                                             : dice.tenths(2.5, 5.0);
    plan_.streets.push_back({.highway = kind_of_lane(width_m),
                             .name = names[i],
                             .axis_m = snapped_ring(street.axis_m),
                             .width_m = width_m});
  }
}

/// The largest cell near the middle is the market, its largest neighbour has the church, the
/// largest cell far from the middle is the garden.
OpenPlaces OldTown::choose_open_places() const {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::set<std::size_t> taken;
  const auto largest = [&](const auto& suits) {
    std::size_t best = kNone;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (taken.count(cell) == 0 && suits(cell) &&
          (best == kNone || area_m2(cells_[cell]) > area_m2(cells_[best]))) {
        best = cell;
      }
    }
    taken.insert(best);
    return best;
  };
  const auto off_middle = [&](std::size_t cell) {
    return centroid(cells_[cell]).norm() / parameters_.size_m;
  };
  OpenPlaces open;
  open.market = largest([&](std::size_t cell) { return off_middle(cell) < 0.2; });
  open.church = largest([&](std::size_t cell) {
    return open.market != kNone &&
           std::any_of(cells_[cell].begin(), cells_[cell].end(), [&](const CellCorner& corner) {
             return corner.across == static_cast<int>(open.market);
           });
  });
  open.small_square =
      largest([&](std::size_t cell) { return off_middle(cell) > 0.25 && off_middle(cell) < 0.4; });
  open.garden = largest([&](std::size_t cell) { return off_middle(cell) >= 0.35; });
  return open;
}

/// What the streets around a cell leave of it.
ConvexCell OldTown::block_of(std::size_t cell) const {
  const auto half_street = [&](int across) {
    return plan_.streets[web_.street_of(static_cast<int>(cell), across)].width_m / 2.0;
  };
  return without_short_edges(inset(cells_[cell], half_street), kShortestWall_m);
}

void OldTown::make_square(const ConvexCell& block, const char* name, Dice& dice) {
  plan_.squares.push_back({.name = name, .outline = snapped_ring(ring_of(block))});
  plant_around(block, kTreesApart_m, dice, plan_.trees);
}

void OldTown::make_churchyard(const ConvexCell& block, Dice& dice) {
  if (auto church = church_in(block, dice)) {
    plan_.buildings.push_back(std::move(*church));
  } else {
    build(block, dice);
  }
}

void OldTown::build(const ConvexCell& block, Dice& dice) {
  if (block.empty() || area_m2(block) < kSmallestHouse_m2 ||
      narrowest_m(block) < kNarrowestHouse_m) {
    return;  // a widening of the street
  }
  const bool palace = dice.chance(kPalaces);
  const auto lots = palace ? std::vector<ConvexCell>{block} : divided(block, kHouses, dice);
  const auto outlines = outlines_with_common_corners(lots);
  for (std::size_t i = 0; i < lots.size(); ++i) {
    PlannedBuilding house{.use = palace ? "palace" : "house",
                          .name = {},
                          .footprint = {.outer = outlines[i], .courtyards = {}},
                          .height_m = dice.tenths(parameters_.lowest_m, parameters_.highest_m),
                          .walls = dice.chance(kStoneWalls) ? Material::kStone : Material::kBrick,
                          .parts = {}};
    if (palace || dice.chance(kCourtyards)) {
      constexpr double kSmallestCourtyard_m2 = 40.0;
      Ring courtyard = courtyard_in(lots[i], dice.uniform(7.0, 10.0), kSmallestCourtyard_m2);
      if (!courtyard.empty()) {
        house.footprint.courtyards.push_back(std::move(courtyard));
      }
    }
    plan_.buildings.push_back(std::move(house));
  }
}

}  // namespace

Plan old_town(const OldTownParameters& parameters, std::uint64_t seed) {
  check_size(parameters.size_m);
  return OldTown{parameters, seed}.plan();
}

}  // namespace cuscus::city::generate
