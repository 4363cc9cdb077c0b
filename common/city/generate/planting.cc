#include "common/city/generate/planting.h"

#include <cmath>

#include "common/city/generate/lots.h"

namespace cuscus::city::generate {
namespace {

constexpr double kFromEdge_m = 4.0;

}  // namespace

Tree city_tree(const Eigen::Vector2d& foot, Dice& dice) {
  const Eigen::Vector2d at = snapped(foot);
  return {.foot_m = {at.x(), at.y(), 0.0},
          .height_m = dice.tenths(6.0, 12.0),
          .crown_radius_m = dice.tenths(1.5, 3.0)};
}

void plant_row(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double spacing_m, Dice& dice,
               std::vector<Tree>& trees) {
  const auto gaps = static_cast<int>(std::lround((b - a).norm() / spacing_m));
  for (int i = 0; i <= gaps; ++i) {
    trees.push_back(
        city_tree(a + (b - a) * (gaps > 0 ? static_cast<double>(i) / gaps : 0.5), dice));
  }
}

void plant_around(const ConvexCell& square, double spacing_m, Dice& dice,
                  std::vector<Tree>& trees) {
  const ConvexCell inner = without_short_edges(inset(square, kFromEdge_m), spacing_m / 2.0);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const Eigen::Vector2d& a = inner[i].p;
    const Eigen::Vector2d& b = inner[(i + 1) % inner.size()].p;
    const auto gaps = std::max(1L, std::lround((b - a).norm() / spacing_m));
    for (long k = 0; k < gaps; ++k) {
      trees.push_back(
          city_tree(a + (b - a) * (static_cast<double>(k) / static_cast<double>(gaps)), dice));
    }
  }
}

Wood wood_on(const ConvexCell& cell, Dice& dice) {
  return {.footprint = {.outer = snapped_ring(ring_of(cell)), .courtyards = {}},
          .bottom_m = 0.0,
          .top_m = dice.tenths(8.0, 14.0)};
}

}  // namespace cuscus::city::generate
