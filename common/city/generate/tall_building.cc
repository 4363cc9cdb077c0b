#include "common/city/generate/tall_building.h"

#include <algorithm>
#include <cmath>

#include "common/city/generate/lots.h"

namespace cuscus::city::generate {
namespace {

constexpr double kNarrowestTower_m = 12.0;
constexpr double kSmallestLightWell_m2 = 80.0;

Material material_of(Dice& dice) {
  const double drawn = dice.uniform(0.0, 1.0);
  return drawn < 0.5 ? Material::kConcrete : drawn < 0.8 ? Material::kGlass : Material::kBrick;
}

/// Storeys that are each narrower than the ones under them: `steps` times, while there is room.
std::vector<Prism> set_back(const ConvexCell& lot, const Ring& outline, double height_m, int steps,
                            Dice& dice) {
  std::vector<Prism> parts{
      {.footprint = {.outer = outline, .courtyards = {}}, .bottom_m = 0.0, .top_m = height_m}};
  ConvexCell storey = lot;
  for (int step = 0; step < steps; ++step) {
    storey = inset(storey, dice.uniform(3.0, 6.0));
    if (storey.empty() || narrowest_m(storey) < kNarrowestTower_m) {
      break;
    }
    const double from_m = parts.back().bottom_m;
    parts.back().top_m = from_m + std::max(6.0, dice.uniform(0.2, 0.4) * (height_m - from_m));
    parts.back().top_m = std::round(parts.back().top_m * 10.0) / 10.0;
    parts.push_back({.footprint = {.outer = snapped_ring(ring_of(storey)), .courtyards = {}},
                     .bottom_m = parts.back().top_m,
                     .top_m = height_m});
  }
  return parts;
}

}  // namespace

PlannedBuilding tall_building(const ConvexCell& lot, const Ring& outline, double height_m,
                              Dice& dice) {
  PlannedBuilding building{.use = dice.chance(0.6) ? "office" : "apartments",
                           .name = {},
                           .footprint = {.outer = outline, .courtyards = {}},
                           .height_m = height_m,
                           .walls = material_of(dice),
                           .parts = {}};
  const double drawn = dice.uniform(0.0, 1.0);
  if (drawn < 0.45) {
    building.parts = set_back(lot, outline, height_m, drawn < 0.3 ? 1 : 2, dice);
    if (building.parts.size() == 1) {
      building.parts.clear();
    }
  } else if (drawn < 0.65) {
    Ring well = courtyard_in(lot, dice.uniform(9.0, 12.0), kSmallestLightWell_m2);
    if (!well.empty()) {
      building.footprint.courtyards.push_back(std::move(well));
    }
  }
  return building;
}

}  // namespace cuscus::city::generate
