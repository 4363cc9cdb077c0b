#include "common/city/generate/church.h"

#include <algorithm>

namespace cuscus::city::generate {
namespace {

constexpr int kLongestNave_m = 44;
constexpr int kShortestNave_m = 18;
constexpr double kNaveWidth = 0.42;  // of its length
constexpr double kTowerSide = 0.5;   // of the nave's width
constexpr double kFreeAround_m = 2.0;

/// A plan of the church with its length along x, in units of the nave's length.
struct ChurchPlan {
  Ring outline, nave, tower;
};

ChurchPlan church_plan() {
  const double width = kNaveWidth;
  const double side = kNaveWidth * kTowerSide;
  const Eigen::Vector2d shift{-(1.0 - side) / 2.0, -width / 2.0};
  ChurchPlan plan{
      .outline = {{-side, 0}, {0, 0}, {1, 0}, {1, width}, {0, width}, {0, side}, {-side, side}},
      .nave = {{0, 0}, {1, 0}, {1, width}, {0, width}, {0, side}},
      .tower = {{-side, 0}, {0, 0}, {0, side}, {-side, side}}};
  for (Ring* ring : {&plan.outline, &plan.nave, &plan.tower}) {
    for (Eigen::Vector2d& corner : *ring) {
      corner += shift;
    }
  }
  return plan;
}

Ring placed(const Ring& ring, const Eigen::Vector2d& middle, const Eigen::Vector2d& along,
            double nave_m) {
  const Eigen::Vector2d across{-along.y(), along.x()};
  Ring result;
  for (const Eigen::Vector2d& corner : ring) {
    result.push_back(snapped(middle + (along * corner.x() + across * corner.y()) * nave_m));
  }
  return result;
}

}  // namespace

std::optional<PlannedBuilding> church_in(const ConvexCell& block, Dice& dice) {
  const ConvexCell free = inset(block, kFreeAround_m);
  if (free.empty()) {
    return std::nullopt;
  }
  const ChurchPlan plan = church_plan();
  const Eigen::Vector2d along = long_direction(free);
  const Eigen::Vector2d middle = centroid(free);
  for (int nave_m = kLongestNave_m; nave_m >= kShortestNave_m; --nave_m) {
    const Ring outline = placed(plan.outline, middle, along, nave_m);
    if (!std::all_of(outline.begin(), outline.end(),
                     [&](const Eigen::Vector2d& corner) { return contains(free, corner); })) {
      continue;
    }
    const double roof_m = dice.tenths(15.0, 22.0);
    const double tower_m = dice.tenths(38.0, 55.0);
    return PlannedBuilding{
        .use = "church",
        .name = "Old Church",
        .footprint = {.outer = outline, .courtyards = {}},
        .height_m = tower_m,
        .walls = Material::kStone,
        .parts = {
            {.footprint = {.outer = placed(plan.nave, middle, along, nave_m), .courtyards = {}},
             .bottom_m = 0.0,
             .top_m = roof_m},
            {.footprint = {.outer = placed(plan.tower, middle, along, nave_m), .courtyards = {}},
             .bottom_m = 0.0,
             .top_m = tower_m}}};
  }
  return std::nullopt;
}

}  // namespace cuscus::city::generate
